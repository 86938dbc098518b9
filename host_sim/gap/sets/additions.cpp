// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/additions.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "gap/likelihood/prior.hpp"
#include "gap/model/carried_record.hpp"
#include "gap/sets/joint_scan.hpp"
#include "parallel/work_in_parallel.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

/// What free runs leave beyond the model on the measured motion.
Spectrum left_by_runs(const FittedSet& one, SimulatedModel& run, const SpectralRecord& record, const Parts& parts) {
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

Additions::Additions(const FittedSet& from, const FittedSet* near, const SetFitter& fitter)
    : setting_(fitter.setting()),
      from_(from),
      parts_(from.set.hypotheses()),
      run_(setting_.record, parts_, from.course),
      record_(carried_record(setting_.record, run_, from.at())),
      offset_(left_by_runs(from, run_, record_, parts_)),
      fitted_(fitter.fitted(from.set)) {
  RunSlopes slopes(record_, parts_);
  for (const FittedSet* one : {&from, near}) {
    if (one == nullptr) continue;
    std::vector<Spectrum> along = slopes.at(one->fit.x, fitted_);
    LinearScan scan(record_, parts_, one->fit, kSeen, offset_, along);
    origins_.push_back({std::move(scan), one->at(), with_torques_of(one->at(), record_), std::move(along)});
  }
  for (const auto& hypothesis : hypotheses()) {
    if (may_add(hypothesis->type())) candidates_.push_back({hypothesis.get()});
  }
  work_in_parallel(candidates_.size(), setting_.threads, [&](std::size_t i) {
    for (const SearchOrigin& origin : origins_) {
      candidates_[i].points.push_back(starting_points(*candidates_[i].hypothesis, record_, origin));
    }
  });
}

bool Additions::may_add(const EffectType& type) const {
  if (!setting_.allows(type)) return false;
  if (std::ranges::find(from_.set.removed, &type) != from_.set.removed.end() || from_.set.has(type)) return false;
  return goes_with(type, from_.at().effects);
}

/// Among the first few around either origin. What is promised around one is not to be compared with what is around the
/// other: where J, B and C are far from the simulation's, everything promises much there.
bool Additions::promises_most(const Candidate& candidate, double least) const {
  constexpr std::size_t kScanned = 6;
  const auto promised = [](const Candidate& one, std::size_t origin) {
    return one.hypothesis->acts() && !one.points[origin].empty() ? one.points[origin].front().nats : 0.0;
  };
  for (std::size_t origin = 0; origin < origins_.size(); ++origin) {
    const double own = promised(candidate, origin);
    const auto more =
        std::ranges::count_if(candidates_, [&](const Candidate& one) { return promised(one, origin) > own; });
    if (own >= least && std::cmp_less(more, kScanned)) return true;
  }
  return false;
}

/// The most promising single ones, each refined on the motion of the base's run.
std::vector<Move> Additions::single(double dispersion) const {
  struct Added {
    const Candidate* candidate = nullptr;
    double nats = 0;  ///< reached
    Whittle::Fit fit{};
  };
  std::vector<Added> all;
  for (const Candidate& candidate : candidates_) {
    if (!candidate.hypothesis->acts() || promises_most(candidate, kLeast * dispersion)) {
      all.push_back({&candidate});
    }
  }
  work_in_parallel(all.size(), setting_.threads, [&](std::size_t i) {
    std::vector<StartingPoint> starts;
    for (const auto& around : all[i].candidate->points) starts.insert(starts.end(), around.begin(), around.end());
    all[i].fit = search(*all[i].candidate->hypothesis, {record_, setting_.whittle, std::move(starts), parts_,
                                                        setting_.wheel, kSeen, from_.set.slow, offset_, fitted_});
    all[i].nats = all[i].fit.cost(kSeen);
  });
  std::ranges::sort(all, {}, &Added::nats);
  constexpr std::size_t kRunAtFirst = 8;
  constexpr std::size_t kRunLater = 4;
  const std::size_t most = from_.set.changes() == 0 ? kRunAtFirst : kRunLater;
  std::erase_if(all, [&](const Added& one) { return from_.fit.cost(kSeen) - one.nats < kLeast * dispersion; });
  if (all.size() > most) all.resize(most);
  std::vector<Move> moves;
  for (const Added& one : all) {
    const Hypothesis& hypothesis = *one.candidate->hypothesis;
    const EffectSet set = with_added(from_.set, hypothesis);
    Point at = Point::of(one.fit.x, set.hypotheses());
    Effect& added = at.effects.back();
    added.values = hypothesis.to_run(added.values, at.wheel);
    moves.push_back({set, at, from_.course});
    if (hypothesis.sticks()) {
      const Effect alike = std::move(added);
      at.effects.pop_back();
      add_relatives(hypothesis, alike, {from_.set, at, from_.course}, setting_, moves);
    }
  }
  if (from_.set.slow == SlowTorque::kFloor && may_add(effect::unmeasured_torque)) {
    moves.push_back({from_.set, from_.at(), from_.course});
    moves.back().set.slow = SlowTorque::kCause;
  }
  return moves;
}

std::vector<Move> Additions::joint() const {
  constexpr std::size_t kEach = 2;  // subsets of two, and of three
  std::vector<JointCandidate> candidates;
  for (const Candidate& one : candidates_) candidates.push_back({one.hypothesis, one.points.back()});
  std::vector<Move> moves;
  for (JointStart& start : joint_starts({record_, parts_, origins_.back(), offset_, kUsualError}, candidates, kEach)) {
    Move& move = moves.emplace_back(from_.set, std::move(start.at), from_.course);
    for (const Hypothesis* hypothesis : start.added) move.set = with_added(std::move(move.set), *hypothesis);
  }
  return moves;
}

}  // namespace steerid::gap
