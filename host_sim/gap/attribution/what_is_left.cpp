// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/attribution/what_is_left.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

#include "gap/comparison/preferred_fit.hpp"
#include "gap/likelihood/slow_line.hpp"
#include "gap/model/carried_record.hpp"
#include "gap/model/floor_rms.hpp"
#include "gap/model/run_slopes.hpp"
#include "gap/model/simulated_model.hpp"
#include "gap/model/slow_in_run.hpp"
#include "parallel/work_in_parallel.hpp"
#include "sensors/random.hpp"

namespace steerid {
namespace {

constexpr double kUsualSlow = 0.02;  // share of the applied torque
/// How much larger a slow torque may be in one part of a record than what is estimated from another: below 0.3 Hz 20 s
/// have some ten degrees of freedom, and so have those that it was estimated on (95 % of their F distribution: 3).
constexpr double kUpper = 2.5;

/// A torque that nobody measured has no course to run with, and an absence that was seen says little of the others.
bool runs_freely(std::string_view id) { return id != "unmeasured_torque" && id != "hands_off"; }

/// Whether a loop holds a wheel that does not hold itself: one that a spring lets go, or that its own reflex shakes.
/// Its free run leaves for good what it strays by, and says nothing of the fit.
bool held_by_the_loop(const ComparisonSetting& setting, const SpectralModel::Parts& parts, const Candidate& one,
                      const ComparedParts& there) {
  if (!setting.whittle.white().at_most) return false;
  return !holds_itself(setting.record.record, setting.record.stretches, wheel_of(one.fit.x),
                       effects_at(one.fit.x, parts, there.fixed), setting.record.between());
}

/// How far the numbers of a linear wheel, drawn from what its blocks leave open, move its run on the choosing blocks:
/// the mean square, rad^2. A reflex that takes nearly all of the damping leaves a wheel that rings for seconds; blocks
/// say little of that (what rings within one looks like what it begins with), and 1 % of the damping moves the run by
/// more than the gap.
double left_open_by_blocks_rad2(const ComparisonSetting& setting, const SpectralModel::Parts& parts,
                                SimulatedModel& model, const Whittle::Fit& fit) {
  constexpr int kDraws = 6;
  constexpr std::uint64_t kSeed = 1;
  Random random(kSeed, 31);
  const std::vector<Fitted> fitted = fitted_parameters(setting.sim, setting.refit, parts);
  const Eigen::LLT<Eigen::MatrixXd> information(fit.information);
  const std::span<const double> run_rad = model.run(fit.x);
  if (information.info() != Eigen::Success || run_rad.empty()) return 0;
  const std::vector<double> found_rad(run_rad.begin(), run_rad.end());
  double sum = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    Eigen::VectorXd normals(fit.x.size());
    for (double& one : normals) one = random.normal();
    const Eigen::VectorXd x = within(fit.x + information.matrixU().solve(normals), fitted);
    const double moved_rad = model.rms_rad(x, Block::Role::kChoose, found_rad);
    sum += moved_rad * moved_rad;
  }
  return sum / kDraws;
}

/// Squared error of a free run over that of the closest wheel's, both less what noise leaves; nothing where it says
/// nothing.
std::optional<double> run_error(double left, double closest, double noise) {
  // A closest wheel that hardly leaves more than noise leaves no gap to hold a run against: the floor is not known
  // better than what that wheel leaves. A run that strays much further contradicts.
  constexpr double kTold = 1.2;
  constexpr double kMuchFurther = 2;
  constexpr double kNothingLeft = 1e-3;
  if (closest > kTold * noise) return std::max((left - noise) / (closest - noise), kNothingLeft);
  return left > kMuchFurther * closest ? std::optional(left / closest) : std::nullopt;
}

/// Of every single one, where a spring holds the wheel and no loop's answers are taken for noise.
void note_slow_in_run(const ComparisonSetting& setting, const ComparedParts& there,
                      std::vector<Candidate>& candidates) {
  if (!(setting.sim.stiffness_nm_per_rad > 0) || setting.whittle.white().at_most) return;
  work_in_parallel(candidates.size(), setting.threads, [&](std::size_t i) {
    SimulatedModel run(setting.record, there.with(candidates[i].type), there.fixed);
    candidates[i].slow_share_of_run = slow_share_of_run(setting.record, setting.whittle, run, candidates[i].fit);
  });
}

/// What a free run of the closest wheel without an effect leaves.
double closest_rms_rad(const ComparisonSetting& setting, const ComparedParts& there) {
  return SimulatedModel(setting.record, {}, there.fixed).rms_rad(joined(setting.closest, {}), Block::Role::kChoose);
}

void note_run_beside(double closest_rad, const ComparisonSetting& setting, const ComparedParts& there, Candidate& one) {
  // Without a spring even a usual slow torque takes a run anywhere.
  const bool held = setting.sim.stiffness_nm_per_rad > 0;
  const bool runs = held && setting.slow == SlowTorque::kFloor && runs_freely(one.id) &&
                    std::ranges::all_of(there.parts, [](const Hypothesis* p) { return runs_freely(p->type().id); });
  const SpectralModel::Parts all = there.with(one.type);
  if (one.type == nullptr || !runs || held_by_the_loop(setting, all, one, there)) return;
  SimulatedModel model(setting.record, all, there.fixed);
  const double left = std::pow(model.rms_rad(one.fit.x, Block::Role::kChoose), 2);
  // What a model misses makes its slow torque larger than any driver's.
  const double usual_variance = std::pow(kUsualSlow * setting.whittle.applied_rms_nm(), 2);
  NoiseFloor upper = one.fit.floor;
  upper.slow_variance = std::min(kUpper * upper.slow_variance, usual_variance);
  const double noise = std::pow(floor_rms_rad(upper, held_gain(wheel_of(one.fit.x)), 0), 2);
  one.run_error = run_error(left, closest_rad * closest_rad, noise);
  constexpr double kSpeaks = 0.2;  // half of what leaves a fit half unknown
  if (one.run_error.value_or(0) > kSpeaks && std::ranges::none_of(all, &Hypothesis::acts)) {
    const double moved = left_open_by_blocks_rad2(setting, all, model, one.fit);
    one.run_error = run_error(std::max(left - moved, 0.0), closest_rad * closest_rad, noise);
  }
}

}  // namespace

void note_run(const ComparisonSetting& setting, const ComparedParts& there, Candidate& one) {
  note_run_beside(closest_rms_rad(setting, there), setting, there, one);
}

void note_shapes(const ComparisonSetting& setting, const ComparedParts& there, Candidate& one) {
  const SpectralModel::Parts all = there.with(one.type);
  const auto fitted = fitted_parameters(setting.sim, setting.refit, all);
  std::optional<SpectralRecord> carried;
  SimulatedModel with_slow(setting.record, all, there.fixed, one.course);
  if (one.motion == Motion::kCarried) carried.emplace(carried_record(setting.record, with_slow, one.fit.x));
  const SpectralRecord& record = carried ? *carried : setting.record;
  SpectralModel on_motion(record, all);
  // The angle's noise in the motion would stand in slopes and shapes, and explain itself. But the run of a wheel that
  // is let go a little early or late is soon elsewhere.
  std::optional<SpectralRecord> quiet;
  if (!leaves(there, one)) quiet.emplace(carried_record(setting.record, with_slow, one.fit.x, kSlowBeyondRun_hz));
  const SpectralRecord& shaped = quiet ? *quiet : record;
  RunSlopes slopes(shaped, all);
  ResidualModel& judged = one.motion == Motion::kFreeRuns ? static_cast<ResidualModel&>(with_slow) : on_motion;
  if (one.id == "unmeasured_torque") one.slow_line_share = slow_line_share(setting.whittle, judged, one.fit);
  one.rivals = rivals_beyond(shaped, setting.whittle, judged, slopes, one.fit, fitted, setting.slow_beside(one.type),
                             setting.threads);
}

void note_runs(const ComparisonSetting& setting, const ComparedParts& there, std::vector<Candidate>& candidates) {
  double closest_rad = closest_rms_rad(setting, there);
  if (there.parts.empty()) {
    SimulatedModel alone(setting.record, {}, there.fixed);
    closest_rad = std::min(closest_rad, alone.rms_rad(candidates[1].fit.x, Block::Role::kChoose));
    note_slow_in_run(setting, there, candidates);
  }
  constexpr std::size_t kMost = 4;
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), 0U);
  const Whittle::Roles& roles = roles_of("", there);
  std::ranges::sort(order, {}, [&](std::size_t i) { return candidates[i].fit.cost(roles); });
  order.resize(std::min(kMost, order.size()));
  work_in_parallel(order.size(), setting.threads,
                   [&](std::size_t i) { note_run_beside(closest_rad, setting, there, candidates[order[i]]); });
}

}  // namespace steerid
