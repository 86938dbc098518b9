// The stage by free runs, from where the stage before it may end (gap/drawn_drive.hpp makes the drives).
#include "gap/comparison/free_run_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "gap/drawn_drive.hpp"
#include "gap/model/compared_parts.hpp"
#include "gap/model/simulated_model.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

/// On the measured motion a spring may come out a little too soft to hold the wheel: no free run begins there, and none
/// says which way is better.
TEST(FreeRunStage, LeavesASpringThatLetsTheWheelGo) {
  constexpr double kCubic = -200;
  test::DrawnDrive what;
  what.torque = [](double, double x, double) { return -kCubic * x * x * x; };
  const Record record = test::drive(what, test::seed(84));
  const SpectralRecord spectral(record, what.wheel, held_out_split(record, 100), 100, false);
  const Whittle whittle(spectral.spectra, NoiseFloor::of(record, what.wheel, 100, 50), spectral.applied_rms_nm);
  const ComparisonSetting setting{
      .record = spectral, .whittle = whittle, .sim = what.wheel, .refit = what.wheel, .closest = what.wheel};
  const ComparedParts there = compared_parts({});
  SimulatedModel runs(spectral, compared_parts({Effect(effect::cubic_stiffness)}).parts);
  Eigen::Vector4d x(what.wheel.inertia_kgm2, what.wheel.damping_nms_per_rad, what.wheel.stiffness_nm_per_rad, kCubic);
  ASSERT_FALSE(runs.run(x).empty());
  x[3] *= 1.4;
  ASSERT_TRUE(runs.run(x).empty());
  const SpectralModel::Parts parts = there.with(&effect::cubic_stiffness);
  SpectralModel on_motion(spectral, parts);
  std::vector<Candidate> candidates = {{.id = "cubic_stiffness", .type = &effect::cubic_stiffness, .fit = {}}};
  candidates[0].fit =
      whittle.judge(on_motion, x, fitted_parameters(what.wheel, what.wheel, parts), kFitted, SlowTorque::kFloor);
  fit_by_free_runs(setting, there, candidates);
  EXPECT_EQ(candidates[0].motion, Motion::kFreeRuns);
  EXPECT_NEAR(candidates[0].fit.x[3], kCubic, 0.02 * -kCubic);
  EXPECT_NEAR(candidates[0].fit.excess(kSeen), 1, 0.15);  // some 500 lines
}

/// Beside a delay, which is linear, the measured motion shows what a second effect gains: what gains a hundredth there
/// is not run, what gains a fifth is.
TEST(FreeRunStage, RunsBesideALinearEffectWhatGainsOnTheMeasuredMotion) {
  const test::DrawnDrive what;
  const Record record = test::drive(what, test::seed(85));
  const SpectralRecord spectral(record, what.wheel, held_out_split(record, 100), 100, false);
  const Whittle whittle(spectral.spectra, NoiseFloor::of(record, what.wheel, 100, 50), spectral.applied_rms_nm);
  const ComparisonSetting setting{
      .record = spectral, .whittle = whittle, .sim = what.wheel, .refit = what.wheel, .closest = what.wheel};
  const ComparedParts there = compared_parts({Effect(effect::delay)});
  const auto candidate = [&](const char* id, const EffectType* type, double excess) {
    const SpectralModel::Parts parts = there.with(type);
    SpectralModel on_motion(spectral, parts);
    std::vector<Effect> effects = {Effect(effect::delay)};
    if (type != nullptr) effects.emplace_back(*type);
    Candidate one{.id = id, .type = type, .fit = {}};
    one.fit = whittle.judge(on_motion, joined(what.wheel, effects), fitted_parameters(what.wheel, what.wheel, parts),
                            kFitted, SlowTorque::kFloor);
    Misfit& fitted = one.fit.misfit[static_cast<std::size_t>(Block::Role::kFit)];
    fitted.cost += excess * fitted.lines - fitted.chi;
    fitted.chi = excess * fitted.lines;
    return one;
  };
  std::vector<Candidate> candidates = {candidate("none", nullptr, 2.1), candidate("parameters", nullptr, 2),
                                       candidate("quadratic_damping", &effect::quadratic_damping, 1.98),
                                       candidate("cubic_stiffness", &effect::cubic_stiffness, 1.6)};
  fit_by_free_runs(setting, there, candidates);
  EXPECT_EQ(candidates[2].motion, Motion::kMeasured);
  EXPECT_FALSE(candidates[2].compared);
  EXPECT_TRUE(candidates[3].compared);
}

/// On the measured motion one kind of friction can be far better than another that free runs fit as well: where one is
/// run, all are.
TEST(FreeRunStage, RunsEveryKindOfAFrictionThatIsRun) {
  test::DrawnDrive what;
  what.dry_friction_nm = 0.3;
  const Record record = test::drive(what, test::seed(86));
  const SpectralRecord spectral(record, what.wheel, held_out_split(record, 100), 100, false);
  const Whittle whittle(spectral.spectra, NoiseFloor::of(record, what.wheel, 100, 50), spectral.applied_rms_nm);
  const ComparisonSetting setting{
      .record = spectral, .whittle = whittle, .sim = what.wheel, .refit = what.wheel, .closest = what.wheel};
  const ComparedParts there = compared_parts({});
  const auto candidate = [&](const EffectType& type, double excess) {
    const SpectralModel::Parts parts = there.with(&type);
    SpectralModel on_motion(spectral, parts);
    Candidate one{.id = std::string(type.id), .type = &type, .fit = {}};
    one.fit = whittle.judge(on_motion, joined(what.wheel, {Effect(type)}),
                            fitted_parameters(what.wheel, what.wheel, parts), kFitted, SlowTorque::kFloor);
    Misfit& fitted = one.fit.misfit[static_cast<std::size_t>(Block::Role::kFit)];
    fitted.cost = fitted.chi = excess * fitted.lines;
    one.fit.penalty = 0;
    return one;
  };
  // The fourth of the best is the last that is run; here it is a friction.
  std::vector<Candidate> candidates = {candidate(effect::cubic_stiffness, 1.5), candidate(effect::torque_ripple, 1.7),
                                       candidate(effect::quadratic_damping, 1.9),
                                       candidate(effect::stribeck_friction, 2.5),
                                       candidate(effect::coulomb_friction, 40)};
  fit_by_free_runs(setting, there, candidates);
  EXPECT_TRUE(candidates[3].compared);
  EXPECT_TRUE(candidates[4].compared);
}

}  // namespace
}  // namespace steerid
