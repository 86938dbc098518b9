// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A drawn drive as a search over sets takes it, with the true wheel for the simulation's.
#pragma once

#include <cstdint>
#include <utility>

#include "gap/drawn_drive.hpp"
#include "gap/model/point.hpp"
#include "gap/sets/set_fit.hpp"

namespace steerid::test {

struct ComparedDrive {
  ComparedDrive(DrawnDrive what, std::uint64_t seed)
      : drive(std::move(what)),
        record(test::drive(drive, seed)),
        spectral(record, drive.wheel, gap::held_out_split(record), false),
        whittle(spectral.spectra, gap::NoiseFloor::of(record, drive.wheel, 50), spectral.applied_rms_nm),
        setting{.record = spectral, .whittle = whittle, .wheel = drive.wheel, .given = {}} {}
  ComparedDrive(const ComparedDrive&) = delete;  // its parts refer to each other
  ComparedDrive& operator=(const ComparedDrive&) = delete;

  /// What a model leaves at `x`, fitted or not.
  [[nodiscard]] gap::Whittle::Fit judged(gap::ResidualModel& model, const Eigen::VectorXd& x, const gap::Parts& parts,
                                         const gap::Whittle::Roles& roles = gap::kFitted) const {
    return whittle.judge(model, x, fitted_parameters(drive.wheel, parts), roles, gap::SlowTorque::kFloor);
  }

  /// The wheel with one effect added, J, B and C free.
  [[nodiscard]] static gap::EffectSet with(const EffectType& type) {
    gap::EffectSet set;
    set.parts.push_back({gap::hypothesis_of(type), gap::Stands::kAdded});
    set.wheel_given = false;
    return set;
  }

  DrawnDrive drive;
  Record record;
  gap::SpectralRecord spectral;
  gap::Whittle whittle;
  gap::SetSetting setting;
};

}  // namespace steerid::test
