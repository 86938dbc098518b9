// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/set_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "gap/likelihood/fit_spread.hpp"
#include "gap/model/carried_record.hpp"
#include "gap/model/run_slopes.hpp"
#include "gap/model/simulated_model.hpp"

namespace steerid::gap {
namespace {

constexpr double kMuch = 30;  // nats over the excess
constexpr double kWorth = 2;  // of one more round, likewise

/// The deviation of a number's prior.
double prior_sd_of(const Fitted& one, double own_scale) {
  constexpr double kSteps = 12;
  if (one.prior) return one.prior.sd;
  return std::min(kSteps * own_scale, (one.high - one.low) / std::sqrt(12.0));
}

Fitted held_at(double value) { return {.low = value, .high = value, .scale = 0}; }

bool any_part(const EffectSet& set, bool (Hypothesis::*is)() const) {
  return std::ranges::any_of(set.parts, [&](const SetPart& part) { return (part.hypothesis->*is)(); });
}

/// Whether other values of the part may go with another wheel.
bool moves_wheel(const SetPart& part, const EffectSet& set) { return part.as == Stands::kAdded && !set.wheel_given; }

}  // namespace

Hypothesis::Span span_of(const SpectralRecord& record) {
  return {record.motion.time_s.front(), record.motion.time_s.back()};
}

double information_gained(const Eigen::MatrixXd& information, const Eigen::VectorXd& prior_sds) {
  if (information.rows() == 0) return 0;
  Eigen::MatrixXd scaled = prior_sds.asDiagonal() * information * prior_sds.asDiagonal();
  scaled.diagonal().array() += 1;
  return Eigen::LLT<Eigen::MatrixXd>(scaled).matrixLLT().diagonal().array().abs().log().sum();
}

Eigen::VectorXd conditioned(const FittedSet& one, const Held& held) {
  Eigen::VectorXd by = Eigen::VectorXd::Zero(one.fit.x.size());
  for (const auto& [at, value] : held) by[at] = value - one.fit.x[at];
  if (one.fit.information.rows() == 0) return one.fit.x + by;
  Eigen::VectorXd pull = one.fit.information * by;
  Eigen::MatrixXd others = one.fit.information;
  for (const auto& [at, value] : held) {
    pull[at] = 0;
    others.row(at).setZero();
    others.col(at).setZero();
  }
  return one.fit.x + by - covariance_of(others) * pull;
}

bool exact_at_once(const EffectSet& set) {
  return std::ranges::all_of(set.parts, [](const SetPart& part) { return part.hypothesis->exact_at_once(); });
}

std::vector<Fitted> SetFitter::fitted(const EffectSet& set) const {
  const Parts parts = set.hypotheses();
  std::vector<Fitted> all = fitted_parameters(setting_.wheel, parts);
  if (set.wheel_given) {
    all[0] = held_at(setting_.wheel.inertia_kgm2);
    all[1] = held_at(setting_.wheel.damping_nms_per_rad);
    all[2] = held_at(setting_.wheel.stiffness_nm_per_rad);
  }
  for (const SetPart& part : set.parts) {
    const std::span own(all.data() + set.first_number_of(*part.type()), part.type()->parameters.size());
    // Nothing ends at half a turn: a weight of 7 Nm whose phase stood there was the nearest to one of 0.9 Nm beyond it.
    if (const int phase = part.hypothesis->linear().phase; phase >= 0) {
      own[static_cast<std::size_t>(phase)].low -= 2 * std::numbers::pi;
      own[static_cast<std::size_t>(phase)].high += 2 * std::numbers::pi;
    }
    if (part.as != Stands::kGiven) continue;
    const auto given = std::ranges::find(setting_.given, part.type(), &Effect::type);
    for (std::size_t i = 0; i < static_cast<std::size_t>(part.hypothesis->sizes()); ++i)
      own[i] = held_at(given->values[i]);
  }
  return all;
}

std::vector<Fitted> SetFitter::fitted(const FittedSet& one) const {
  std::vector<Fitted> all = fitted(one.set);
  for (const SetPart& part : one.set.parts) {
    const Eigen::Index first = one.set.first_number_of(*part.type());
    for (std::size_t i = 0; i < part.type()->parameters.size(); ++i) {
      if (!part.hypothesis->cut_off_by(span_of(setting_.record), &one.fit.x[first], i)) continue;
      const Eigen::Index at = first + static_cast<Eigen::Index>(i);
      all[static_cast<std::size_t>(at)] = held_at(one.fit.x[at]);
    }
  }
  return all;
}

Eigen::VectorXd SetFitter::gone_on_to_ends(const FittedSet& one) const {
  constexpr double kUntold_nats = 1.96 * 1.96 / 2;  // within an interval of 95 %
  Eigen::VectorXd x = one.fit.x;
  if (one.fit.information.rows() != x.size()) return x;
  for (const SetPart& part : one.set.parts) {
    const Eigen::Index first = one.set.first_number_of(*part.type());
    for (std::size_t i = 0; i < part.type()->parameters.size(); ++i) {
      Eigen::VectorXd further = x;
      WheelArm wheel{x[0], x[1], x[2]};
      WheelArm* moved = moves_wheel(part, one.set) ? &wheel : nullptr;
      if (!part.hypothesis->go_on_to_end(span_of(setting_.record), &further[first], moved, i)) continue;
      further.head<3>() = Point{wheel}.numbers();
      const Eigen::VectorXd by = further - one.fit.x;
      if (by.dot(one.fit.information * by) / 2 < kUntold_nats * std::max(1.0, one.excess())) x = std::move(further);
    }
  }
  return x;
}

void SetFitter::restate(FittedSet& one) const {
  Eigen::VectorXd x = gone_on_to_ends(one);
  const bool moved = x != one.fit.x;
  for (const SetPart& part : one.set.parts) {
    WheelArm wheel{x[0], x[1], x[2]};
    part.hypothesis->restate(span_of(setting_.record), &x[one.set.first_number_of(*part.type())],
                             moves_wheel(part, one.set) ? &wheel : nullptr);
    x.head<3>() = Point{wheel}.numbers();
  }
  if (!moved && x.head<3>() == one.fit.x.head<3>()) {  // the same wheel, and of the others none that moves has a prior
    one.fit.x = std::move(x);
    return;
  }
  // Noise passes another wheel otherwise: what the fit had counted with a C that the ramp undoes holds no more.
  const std::vector<Fitted> numbers = fitted(one.set);
  SimulatedModel run(setting_.record, one.set.hypotheses(), one.course);
  one.fit = setting_.whittle.judge(run, within(std::move(x), numbers), numbers, kSeen, one.set.slow);
  one.motion = Motion::kFreeRuns;
}

Eigen::VectorXd SetFitter::prior_sds(const EffectSet& set) const {
  const std::vector<Fitted> numbers = fitted(set);
  std::vector<double> scales(3, 0.0);
  for (const SetPart& part : set.parts) {
    for (const Parameter& parameter : part.type()->parameters) scales.push_back(parameter.scale);
  }
  const Eigen::Vector3d given = Point{setting_.wheel}.numbers();
  Eigen::VectorXd sds = Eigen::VectorXd::Zero(std::ssize(numbers));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!(numbers[i].scale > 0)) continue;
    const auto at = static_cast<Eigen::Index>(i);
    sds[at] = i >= 3          ? prior_sd_of(numbers[i], scales[i])
              : given[at] > 0 ? kUsualError * std::sqrt(std::numbers::pi / 2) * given[at]
                              : 10 * numbers[i].scale;
  }
  return sds;
}

void SetFitter::price(FittedSet& one) const {
  const std::vector<Fitted> numbers = fitted(one.set);
  if (!exact_at_once(one.set)) {
    RunSlopes slopes(setting_.record, one.set.hypotheses());
    one.fit.information = setting_.whittle.information(one.fit, slopes.at(one.fit.x, numbers), numbers, kSeen);
  }
  one.occam = one.fit.shift + information_gained(one.fit.information, prior_sds(one.set));
  const Eigen::Vector3d given = Point{setting_.wheel}.numbers();
  one.wheel_at_limit = false;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto& [low, high, scale, prior] = numbers[static_cast<std::size_t>(i)];
    if (!(scale > 0 && given[i] > 0)) continue;
    one.wheel_at_limit = one.wheel_at_limit || one.fit.x[i] <= low || one.fit.x[i] >= high;
  }
}

double SetFitter::cost_of_wheel(const FittedSet& one) const {
  Eigen::VectorXd effects = prior_sds(one.set);
  effects.head<3>().setZero();
  return one.occam - information_gained(one.fit.information, effects);
}

FittedSet SetFitter::by_runs(FittedSet one, int budget, bool own_slopes, unsigned threads) const {
  const Parts parts = one.set.hypotheses();
  const std::vector<Fitted> numbers = fitted(one);
  if (one.course) {
    const SlowPrior prior = slow_prior(setting_.record, setting_.whittle, one.set.slow);
    one.course = std::make_shared<const SlowCourse>(
        following(setting_.record, parts, one.fit.x, numbers, prior, *one.course, threads));
  }
  SimulatedModel model(setting_.record, parts, one.course, threads);
  RunSlopes held(setting_.record, parts);
  const auto slopes = [&](const Eigen::VectorXd& x, const std::vector<Fitted>& of) {
    std::vector<Spectrum> along = held.at(x, of);
    for (std::size_t i = 0; one.course && i < along.size(); ++i) along[i] += one.course->follows->slopes[i];
    return along;
  };
  one.fit = setting_.whittle.fit(model, one.fit.x, numbers, kSeen, one.set.slow, budget,
                                 own_slopes ? Slopes() : Slopes(slopes));
  if (one.course) one.course = std::make_shared<const SlowCourse>(one.course->held_at(one.fit.x));
  one.motion = Motion::kFreeRuns;
  return one;
}

FittedSet SetFitter::fit(const EffectSet& set, const Point& start, std::shared_ptr<const SlowCourse> course) const {
  const Parts parts = set.hypotheses();
  const std::vector<Fitted> numbers = fitted(set);
  FittedSet out{.set = set};
  out.fit.x = within(start.numbers(), numbers);
  out.course = std::move(course);
  const auto motion_fit = [&](const SpectralRecord& record) {
    SpectralModel model(record, parts);
    return setting_.whittle.fit(model, out.fit.x, numbers, kSeen, set.slow, kMotionBudget);
  };
  if (exact_at_once(set)) {
    out.fit = motion_fit(setting_.record);
    restate(out);
    price(out);
    return out;
  }
  // That of a set which lacks what this one adds holds a part of it.
  if (out.course && nats_at(set, out.at(), nullptr) < nats_at(set, out.at(), out.course)) out.course = nullptr;
  std::optional<FittedSet> carried;
  std::optional<FittedSet> begun;  // where the runs begin elsewhere
  if (!any_part(set, &Hypothesis::sticks) && !out.course) {
    constexpr int kRounds = 2;
    carried = out;
    for (int round = 0; round < kRounds; ++round) {
      SimulatedModel run(setting_.record, parts);
      const SpectralRecord record = carried_record(setting_.record, run, carried->at());
      SpectralModel on_motion(record, parts);
      carried->fit = setting_.whittle.fit(on_motion, carried->fit.x, numbers, kSeen, set.slow, kMotionBudget);
    }
    carried->motion = Motion::kCarried;
    // A run that is let go a little early or late is soon elsewhere, and the motion that it carries with it.
    if (!any_part(set, &Hypothesis::lets_go)) {
      begun = out;
      out.fit.x = carried->fit.x;
    }
  }
  out = by_runs(std::move(out), kRunBudget, false, 1);
  // What is near on a carried motion may be far by runs.
  if (begun && nats_at(set, begun->at(), nullptr) < out.fit.cost(kSeen)) {
    out = by_runs(std::move(*begun), kRunBudget, false, 1);
  }
  if (carried && out.excess() > kReached && (out.nats() - carried->nats()) / out.excess() > kMuch) out = *carried;
  restate(out);
  price(out);
  return out;
}

double SetFitter::nats_at(const EffectSet& set, const Point& at,
                          const std::shared_ptr<const SlowCourse>& course) const {
  const Parts parts = set.hypotheses();
  const std::vector<Fitted> numbers = fitted(set);
  SpectralModel on_motion(setting_.record, parts);
  SimulatedModel by_runs(setting_.record, parts, course);
  ResidualModel& model = exact_at_once(set) ? static_cast<ResidualModel&>(on_motion) : by_runs;
  return setting_.whittle.judge(model, within(at.numbers(), numbers), numbers, kSeen, set.slow).cost(kSeen);
}

FittedSet SetFitter::settled(FittedSet one, unsigned threads) const {
  if (one.settled || exact_at_once(one.set)) return one;
  const std::vector<Fitted> numbers = fitted(one.set);
  if (one.course && nats_at(one.set, one.at(), nullptr) < one.fit.cost(kSeen)) one.course = nullptr;
  if (one.motion == Motion::kFreeRuns) {
    const bool own = any_part(one.set, &Hypothesis::sticks);
    double gained = 0;
    do {
      FittedSet next = one;
      next.fit.x = within(to_run(one.at()).numbers(), numbers);
      next = by_runs(std::move(next), own ? 4 * kRunBudget : kRunBudget, own, threads);
      gained = (one.nats() - next.nats()) / one.excess();
      if (gained > 0) one = std::move(next);
    } while (gained >= kWorth);
  }
  one = with_slow_course(std::move(one), threads);
  restate(one);
  price(one);
  one.settled = true;
  return one;
}

FittedSet SetFitter::with_slow_course(FittedSet one, unsigned threads) const {
  constexpr double kHopeless = 60;  // an excess that no slow torque makes
  constexpr double kFelt = 4;       // nats of one step towards a course, or a run has no use for one
  constexpr double kOvershot = 10;  // more lost than that: the step was too long
  if (setting_.record.anew_each_block || one.excess() < kReached || one.excess() > kHopeless) return one;
  const SlowPrior prior = slow_prior(setting_.record, setting_.whittle, one.set.slow);
  FittedSet with = one;
  const auto go_on = [&](int steps) {
    with.course = std::make_shared<const SlowCourse>(
        slow_course(setting_.record, with.at(), prior, steps, with.course.get(), threads));
  };
  const auto gained = [&] { return (one.nats() - with.nats()) / with.excess(); };
  if (!one.course) {
    go_on(1);
    SimulatedModel run(setting_.record, one.set.hypotheses(), with.course);
    with.fit = setting_.whittle.judge(run, with.fit.x, fitted(one.set), kSeen, one.set.slow);
    if (gained() > -kOvershot && gained() < kFelt) return one;
    with.fit = one.fit;
  }
  constexpr int kSteps = 3;
  double before_nats = 0;
  do {
    before_nats = with.nats();
    go_on(kSteps);
    with = by_runs(std::move(with), kRunBudget, false, threads);
    if (gained() < kMuch / 2) return one;
  } while ((before_nats - with.nats()) / with.excess() >= kWorth);
  return gained() < kMuch ? one : with;
}

}  // namespace steerid::gap
