// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/stand_in.hpp"

#include <algorithm>

#include "gap/model/compared_parts.hpp"
#include "gap/model/simulated_model.hpp"

namespace steerid {
namespace {

/// What brings a run nearer by less than a tenth is chance as often as not, and no help.
constexpr double kNearer = 0.9;

}  // namespace

std::string stand_in(const PreparedRecord& prepared, const Simulation& simulation, const Comparison& comparison,
                     const std::string& most_probable) {
  // A torque that nobody measured has no course yet to run with; without a spring a run says little of its model.
  if (most_probable.empty() || most_probable == "unmeasured_torque" || prepared.drifts) return most_probable;
  const ComparedParts there = compared_parts(simulation.effects);
  const auto left_rad = [&](const EffectType* type, const Eigen::VectorXd& x) {
    return SimulatedModel(*prepared.spectral, there.with(type), there.fixed).rms_rad(x, Block::Role::kChoose);
  };
  double least_rad = left_rad(nullptr, comparison.at("parameters").fit.x);
  if (there.parts.empty()) {
    least_rad = std::min(least_rad, left_rad(nullptr, joined(prepared.closest, {})));
  }
  least_rad *= kNearer;
  std::string nearest;
  for (const Candidate& one : comparison.candidates) {
    if (there.of(one.type) == nullptr) continue;
    const double own_rad = left_rad(one.type, one.fit.x);
    if (!(own_rad < least_rad)) continue;
    least_rad = own_rad;
    nearest = one.id;
  }
  return nearest;
}

}  // namespace steerid
