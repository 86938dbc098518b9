// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A drawn drive as the comparison of hypotheses takes it, with the true wheel for the simulation's.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gap/comparison/comparison.hpp"
#include "gap/drawn_drive.hpp"
#include "gap/model/compared_parts.hpp"

namespace steerid::test {

struct ComparedDrive {
  ComparedDrive(DrawnDrive what, std::uint64_t seed)
      : drive(std::move(what)),
        record(test::drive(drive, seed)),
        spectral(record, drive.wheel, held_out_split(record, 100), 100, false),
        whittle(spectral.spectra, NoiseFloor::of(record, drive.wheel, 100, 50), spectral.applied_rms_nm),
        setting{
            .record = spectral, .whittle = whittle, .sim = drive.wheel, .refit = drive.wheel, .closest = drive.wheel} {}
  ComparedDrive(const ComparedDrive&) = delete;  // its parts refer to each other
  ComparedDrive& operator=(const ComparedDrive&) = delete;

  /// What a model leaves at `x`, fitted or not.
  [[nodiscard]] Whittle::Fit judged(ResidualModel& model, const Eigen::VectorXd& x, const SpectralModel::Parts& parts,
                                    const Whittle::Roles& roles = kFitted) const {
    return whittle.judge(model, x, fitted_parameters(drive.wheel, drive.wheel, parts), roles, SlowTorque::kFloor);
  }

  /// A candidate on the measured motion, not fitted: the true wheel with the effects that `there` has, and `effect` if
  /// there is one, with their values.
  [[nodiscard]] Candidate candidate(const ComparedParts& there, std::string_view id,
                                    const std::optional<Effect>& effect = std::nullopt,
                                    const Whittle::Roles& roles = kFitted) const {
    const EffectType* type = effect ? effect->type : nullptr;
    const SpectralModel::Parts parts = there.with(type);
    SpectralModel on_motion(spectral, parts);
    std::vector<Effect> effects = there.present;
    if (effect) effects.push_back(*effect);
    return {.id = std::string(id), .type = type, .fit = judged(on_motion, joined(drive.wheel, effects), parts, roles)};
  }

  DrawnDrive drive;
  Record record;
  SpectralRecord spectral;
  Whittle whittle;
  ComparisonSetting setting;
};

}  // namespace steerid::test
