// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A drawn drive as a search over sets takes it, with the true wheel for the simulation's.
#pragma once

#include <cstdint>
#include <utility>

#include "gap/drawn_drive.hpp"
#include "gap/model/compared_parts.hpp"
#include "gap/sets/set_fit.hpp"

namespace steerid::test {

struct ComparedDrive {
  ComparedDrive(DrawnDrive what, std::uint64_t seed)
      : drive(std::move(what)),
        record(test::drive(drive, seed)),
        spectral(record, drive.wheel, held_out_split(record, 100), 100, false),
        whittle(spectral.spectra, NoiseFloor::of(record, drive.wheel, 100, 50), spectral.applied_rms_nm),
        setting{.record = spectral, .whittle = whittle, .wheel = drive.wheel, .given = {}} {}
  ComparedDrive(const ComparedDrive&) = delete;  // its parts refer to each other
  ComparedDrive& operator=(const ComparedDrive&) = delete;

  /// What a model leaves at `x`, fitted or not.
  [[nodiscard]] Whittle::Fit judged(ResidualModel& model, const Eigen::VectorXd& x, const SpectralModel::Parts& parts,
                                    const Whittle::Roles& roles = kFitted) const {
    return whittle.judge(model, x, fitted_parameters(drive.wheel, drive.wheel, parts), roles, SlowTorque::kFloor);
  }

  /// The wheel with one effect added, J, B and C free.
  [[nodiscard]] static EffectSet with(const EffectType& type) {
    EffectSet set;
    set.parts.push_back({hypothesis_of(type), Stands::kAdded});
    set.wheel_given = false;
    return set;
  }

  DrawnDrive drive;
  Record record;
  SpectralRecord spectral;
  Whittle whittle;
  SetSetting setting;
};

}  // namespace steerid::test
