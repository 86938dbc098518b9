// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/set_moves.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <string>
#include <utility>

#include "gap/model/carried_record.hpp"
#include "gap/model/compared_parts.hpp"
#include "gap/model/run_slopes.hpp"
#include "gap/model/simulated_model.hpp"
#include "gap/sets/joint_scan.hpp"
#include "gap/sets/wheel_shift.hpp"
#include "parallel/work_in_parallel.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

/// The set with the effect behind the others.
EffectSet with(EffectSet set, const Hypothesis& hypothesis) {
  set.parts.push_back({&hypothesis, Stands::kAdded});
  return set;
}

/// What free runs leave beyond the model on the measured motion.
Spectrum left_by_runs(const FittedSet& one, SimulatedModel& run, const SpectralRecord& record,
                      const SpectralModel::Parts& parts) {
  Spectrum offset;
  if (one.motion != Motion::kFreeRuns) return offset;
  Spectrum on_motion;
  Response response;
  run.evaluate(one.fit.x, offset, response);
  SpectralModel(record, parts).evaluate(one.fit.x, on_motion, response);
  offset -= on_motion;
  return offset;
}

}  // namespace

std::vector<Effect> given_to_begin(const SetSetting& setting) {
  std::vector<Effect> all = setting.given;
  for (Effect& effect : all) effect.values = hypothesis_of(*effect.type)->to_run(effect.values, setting.wheel);
  return all;
}

std::vector<Move> SetMoves::revisions(const FittedSet& from) const {
  std::vector<Move> moves;
  for (const SetPart& part : from.set.parts) {
    const EffectType& type = part.hypothesis->type();
    if (part.as == Stands::kGiven) {
      moves.push_back({with_resized(from.set, type), from.fit.x, from.course});
      EffectSet alone = moves.back().set;
      alone.wheel_given = true;
      Eigen::VectorXd given = from.fit.x;
      given.head(3) = joined(setting_.wheel, {});
      moves.push_back({std::move(alone), std::move(given), from.course});
    }
    Eigen::VectorXd x = from.fit.x;
    EffectSet rest = without(from.set, type, x);
    moves.push_back({rest, x, from.course});
    if (part.as == Stands::kResized) moves.push_back(as_given_again(from, type));
  }
  for (const EffectType* type : from.set.removed) moves.push_back(as_given_again(from, *type));
  if (from.set.slow == SlowTorque::kCause) {
    moves.push_back({from.set, from.fit.x, from.course});
    moves.back().set.slow = SlowTorque::kFloor;
  }
  std::ranges::move(exchanges(from), std::back_inserter(moves));
  return moves;
}

std::vector<Move> SetMoves::exchanges(const FittedSet& from) const {
  std::vector<Move> moves;
  for (const SetPart& part : from.set.parts) {
    if (part.as != Stands::kAdded) continue;
    Eigen::VectorXd x = from.fit.x;
    const EffectSet rest = without(from.set, part.hypothesis->type(), x);
    exchange(part, from, rest, x, moves);
  }
  return moves;
}

/// With an effect of the simulation as it is given, and with the J, B and C that go with it there: those that were
/// found may make up for its size.
Move SetMoves::as_given_again(const FittedSet& from, const EffectType& type) const {
  Move out{from.set, from.fit.x, from.course};
  if (out.set.has(type)) out.set = without(std::move(out.set), type, out.x);
  std::erase(out.set.removed, &type);
  const std::vector<Effect> given = given_to_begin(setting_);
  std::vector<double> values = std::ranges::find(given, &type, &Effect::type)->values;
  out.set.parts.insert(out.set.parts.begin(), {hypothesis_of(type), Stands::kGiven});
  values.insert(values.begin(),
                {setting_.wheel.inertia_kgm2, setting_.wheel.damping_nms_per_rad, setting_.wheel.stiffness_nm_per_rad});
  values.insert(values.end(), out.x.begin() + 3, out.x.end());
  out.x = Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
  return out;
}

/// Others of its family in the place of what was added, with values that act alike. `rest` at `x`: without it.
void SetMoves::exchange(const SetPart& part, const FittedSet& from, const EffectSet& rest, const Eigen::VectorXd& x,
                        std::vector<Move>& moves) const {
  const EffectType& type = part.hypothesis->type();
  Effect added(type);
  const double* values = from.fit.x.data() + from.set.place_of(type);
  added.values.assign(values, values + added.values.size());
  add_relatives(*part.hypothesis, added, rest, x, from.course, moves);
}

void SetMoves::add_relatives(const Hypothesis& of, const Effect& added, const EffectSet& rest, const Eigen::VectorXd& x,
                             const std::shared_ptr<const SlowCourse>& course, std::vector<Move>& moves) const {
  if (of.family() == Hypothesis::Family::kNone) return;
  for (const auto& other : hypotheses()) {
    if (other->family() != of.family() || other.get() == &of || rest.has(other->type())) continue;
    if (std::ranges::find(setting_.without, other->type().id) != setting_.without.end()) continue;
    if (const auto alike = other->in_place_of(added)) {
      moves.push_back({with(rest, *other), point_at(x, *alike), course});
    }
  }
}

bool SetMoves::may_add(const EffectType& type, const FittedSet& base) const {
  if (std::ranges::find(setting_.without, type.id) != setting_.without.end()) return false;
  if (std::ranges::find(base.set.removed, &type) != base.set.removed.end() || base.set.has(type)) return false;
  std::vector<Effect> present = effects_at(base.fit.x, base.set.hypotheses(), setting_.fixed);
  return goes_with(type, present);
}

struct SetMoves::Candidate {
  const Hypothesis* hypothesis = nullptr;
  std::vector<std::vector<StartingPoint>> points{};  ///< around each origin
};

struct SetMoves::Base {
  Base(const FittedSet& fitted_set, const FittedSet& given_wheel, const SetFitter& fitter)
      : one(fitted_set),
        parts(one.set.hypotheses()),
        run(fitter.setting().record, parts, fitter.setting().fixed, one.course),
        record(carried_record(fitter.setting().record, run, one.fit.x)),
        offset(left_by_runs(one, run, record, parts)),
        fitted(fitter.fitted(one.set)),
        near(given_wheel) {
    const Whittle& whittle = fitter.setting().whittle;
    RunSlopes run_slopes(record, parts);
    const auto begin_at = [&](const Whittle::Fit& fit) {
      slopes = run_slopes.at(fit.x, fitted);
      origins.push_back({LinearScan(record, whittle, parts, fit, kSeen, offset, slopes), fit.x,
                         with_torques_of(parts, record, fit.x)});
    };
    begin_at(one.fit);
    // J, B and C that make up for what is missing may be far from where it is found; the simulation's are near.
    begin_at(near.fit);
  }

  const FittedSet& one;
  SpectralModel::Parts parts;
  SimulatedModel run;
  SpectralRecord record;
  Spectrum offset;
  std::vector<Fitted> fitted;
  const FittedSet& near;
  std::vector<SearchOrigin> origins;  ///< the second with the simulation's J, B and C
  std::vector<Spectrum> slopes;       ///< at that
  std::vector<Candidate> candidates;
};

/// The most promising single ones, each refined on the motion of the base's run.
std::vector<Move> SetMoves::single(const Base& base, double dispersion) const {
  struct Added {
    const Hypothesis* hypothesis = nullptr;
    double nats = 0;  ///< promised, then reached
    Whittle::Fit fit{};
  };
  std::vector<Added> all;
  for (const Candidate& candidate : base.candidates) {
    double promised = 0;
    for (const auto& points : candidate.points) {
      if (!points.empty()) promised = std::max(promised, points.front().nats);
    }
    all.push_back({candidate.hypothesis, promised});
  }
  constexpr std::size_t kScanned = 6;
  std::vector<double> promised;
  promised.reserve(all.size());
  for (const Added& one : all) promised.push_back(one.hypothesis->acts() ? one.nats : 0);
  std::ranges::sort(promised, std::greater());
  double least = kLeast * dispersion;
  if (promised.size() >= kScanned) least = std::max(least, promised[kScanned - 1]);
  std::erase_if(all, [&](const Added& one) { return one.hypothesis->acts() && one.nats < least; });
  work_in_parallel(all.size(), setting_.threads, [&](std::size_t i) {
    all[i].fit = search(*all[i].hypothesis, {base.record, setting_.whittle, base.origins, base.parts, setting_.wheel,
                                             setting_.wheel, kSeen, base.one.set.slow, base.offset, base.fitted});
    all[i].nats = all[i].fit.cost(kSeen);
  });
  std::ranges::sort(all, {}, &Added::nats);
  constexpr std::size_t kRunAtFirst = 8;
  constexpr std::size_t kRunLater = 4;
  const std::size_t most = base.one.set.changes() == 0 ? kRunAtFirst : kRunLater;
  std::erase_if(all, [&](const Added& one) { return base.one.nats() - one.nats < kLeast * dispersion; });
  if (all.size() > most) all.resize(most);
  std::vector<Move> moves;
  for (const Added& one : all) {
    const Eigen::VectorXd origin = origin_of(one.fit.x, one.hypothesis->type());
    Effect added(one.hypothesis->type());
    std::copy(one.fit.x.end() - std::ssize(added.values), one.fit.x.end(), added.values.begin());
    added.values = one.hypothesis->to_run(added.values, wheel_of(one.fit.x));
    moves.push_back({with(base.one.set, *one.hypothesis), point_at(origin, added.values), base.one.course});
    if (one.hypothesis->sticks()) add_relatives(*one.hypothesis, added, base.one.set, origin, base.one.course, moves);
  }
  if (base.one.set.slow == SlowTorque::kFloor && may_add(effect::unmeasured_torque, base.one)) {
    moves.push_back({base.one.set, base.one.fit.x, base.one.course});
    moves.back().set.slow = SlowTorque::kCause;
  }
  return moves;
}

std::vector<Move> SetMoves::joint(const Base& base) const {
  constexpr std::size_t kEach = 2;  // subsets of two, and of three
  std::vector<JointCandidate> candidates;
  for (const Candidate& one : base.candidates) candidates.push_back({one.hypothesis, one.points.back()});
  std::vector<Move> moves;
  for (JointStart& start :
       joint_starts({base.record, setting_.whittle, base.parts, base.near.fit, base.offset, base.slopes, kUsualError},
                    candidates, kEach)) {
    Move& move = moves.emplace_back(base.one.set, std::move(start.x), base.one.course);
    for (const Hypothesis* hypothesis : start.added) move.set = with(std::move(move.set), *hypothesis);
  }
  return moves;
}

SetMoves::Additions SetMoves::additions(const FittedSet& from, const FittedSet& given_wheel, double dispersion) const {
  Base base(from, given_wheel, fitter_);
  for (const auto& hypothesis : hypotheses()) {
    if (may_add(hypothesis->type(), from)) base.candidates.push_back({hypothesis.get()});
  }
  work_in_parallel(base.candidates.size(), setting_.threads, [&](std::size_t i) {
    Candidate& candidate = base.candidates[i];
    for (const SearchOrigin& origin : base.origins) {
      candidate.points.push_back(starting_points(*candidate.hypothesis, base.record, origin));
    }
  });
  return {single(base, dispersion), joint(base)};
}

}  // namespace steerid::gap
