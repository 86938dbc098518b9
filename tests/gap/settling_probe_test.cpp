// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The probe that a diagnosis proposes where it is unsure, played on the wheel itself: the second diagnosis is right.
// The wheel is an integrator of its own (drawn_drive.hpp), and so is the multisine here.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "gap/diagnosis/diagnosis.hpp"
#include "gap/drawn_drive.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

/// The proposal as a page states it, by Schroeder's phases.
std::function<double(double)> played(const ProbeProposal& probe) {
  const auto first = std::lround(probe.low_hz * probe.period_s);
  const auto tones = std::lround(probe.high_hz * probe.period_s) - first + 1;
  return [=](double t) {
    double sum = 0;
    for (long k = 1; k <= tones; ++k) {
      const double turns = static_cast<double>(first + k - 1) / probe.period_s * t;
      sum += std::cos(2 * std::numbers::pi * turns -
                      std::numbers::pi * static_cast<double>(k * (k - 1)) / static_cast<double>(tones));
    }
    return probe.rms_nm * std::sqrt(2.0 / static_cast<double>(tones)) * sum;
  };
}

/// A wheel with a weight that its simulation has, and something that it has not.
struct Drawn {
  test::DrawnDrive what;
  Simulation simulation;
  const EffectType* missing = nullptr;  ///< null: nothing is
};

Drawn drawn(test::Noise& noise, std::size_t which) {
  const auto between = [&](double low, double high) { return low + (high - low) * noise.uniform(); };
  Drawn out;
  out.what.wheel = {between(0.08, 0.15), between(0.8, 1.8), between(15, 35)};
  const double weight_nm = between(0.6, 1.5);
  const double phase_rad = between(-0.5, 0.5);
  const double size = between(0.7, 1.4);
  std::function<double(double, double)> beside = [](double, double) { return 0.0; };
  switch (which) {
    case 0:
      out.missing = &effect::coulomb_friction;
      out.what.dry_friction_nm = 0.12 * size;
      out.what.bristle_rad = 0.0005;
      break;
    case 1:
      out.missing = &effect::lag;
      out.what.lag_s = 0.008 * size;
      break;
    case 2:
      out.missing = &effect::quadratic_damping;
      beside = [size](double, double rate) { return -0.35 * size * std::abs(rate) * rate; };
      break;
    case 3:
      out.missing = &effect::cubic_stiffness;
      beside = [size](double angle, double) { return -400 * size * angle * angle * angle; };
      break;
    default:
      break;
  }
  out.what.torque = [=](double, double angle, double rate) {
    return -weight_nm * std::sin(angle + phase_rad) + beside(angle, rate);
  };
  out.simulation = test::off_by_five_percent(out.what.wheel);
  Effect& weight = out.simulation.effects.emplace_back(effect::gravity_imbalance);
  weight.at("weight_torque_nm") = weight_nm;
  weight.at("phase_rad") = phase_rad;
  return out;
}

std::string changes_of(const Diagnosis& found) {
  std::string all;
  for (const Cause& cause : found.causes) {
    all += fmt::format(" {} {} {:.2f}", name(cause.change), cause.effect.type->id, cause.probability);
  }
  return all.empty() ? found.verdict : all;
}

bool is_right(const Diagnosis& found, const Drawn& truth) {
  if (truth.missing == nullptr) return found.causes.empty() && found.verdict != "unknown";
  return found.causes.size() == 1 && found.causes.front().change == ChangeKind::kAdd &&
         found.causes.front().effect.type == truth.missing;
}

double span_of(const std::vector<double>& angle) {
  const auto [low, high] = std::ranges::minmax_element(angle);
  return *high - *low;
}

Diagnosis diagnosed(const Record& record, const Simulation& simulation) {
  DiagnoseOptions options;
  options.threads = 1;
  options.figures = false;
  return diagnose(record, simulation, options);
}

/// Whether every change is made, or left out, with 95 % or more.
bool is_settled(const Diagnosis& found) {
  return std::ranges::all_of(
      found.inclusion, [](const ChangeInclusion& one) { return one.probability <= 0.05 || one.probability >= 0.95; });
}

TEST(SettlingProbe, PlayedOnTheWheelItSettlesWhatAWeakDriveLeavesOpen) {
  const std::uint64_t seed = test::seed(131);
  constexpr int kPlayed = 3;
  constexpr std::size_t kDrawn = 30;
  int proposed = 0;
  for (std::size_t i = 0; i < kDrawn && proposed < kPlayed; ++i) {
    test::Noise noise(seed + i);
    Drawn truth = drawn(noise, i % 5);
    truth.what.duration_s = 15;
    truth.what.probe_rms_nm = 0.5;
    const Record weak = test::drive(truth.what, seed + 100 + i);
    const Diagnosis before = diagnosed(weak, truth.simulation);
    const NextExperiment& next = before.next_experiment;
    const std::string_view missing = truth.missing == nullptr ? "nothing" : truth.missing->id;
    fmt::print("{:18} of a weak drive:{}. {}\n", missing, changes_of(before), next.why);
    EXPECT_FALSE(next.why.empty());
    if (next.separates[0].empty()) {
      const bool none_would = next.why.starts_with("No probe is proposed");
      EXPECT_TRUE(before.verdict == "unknown" || is_settled(before) || none_would) << missing;
      continue;
    }
    ++proposed;
    truth.what.duration_s = next.probe.duration_s;
    truth.what.probe_nm = played(next.probe);
    const Record strong = test::drive(truth.what, seed + 200 + i);
    const Diagnosis after = diagnosed(strong, truth.simulation);
    fmt::print("{:18} of the probe:{}\n", "", changes_of(after));
    EXPECT_TRUE(is_right(after, truth)) << missing << ":" << changes_of(after);
    // Half as much again as the record went, and what the models that were simulated do not know.
    EXPECT_LE(span_of(strong.angle_rad), 1.2 * 1.5 * span_of(weak.angle_rad)) << missing;
  }
  EXPECT_EQ(proposed, kPlayed);
}

}  // namespace
}  // namespace steerid::gap
