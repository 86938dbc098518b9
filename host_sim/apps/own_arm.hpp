// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The driver's own J, B and C: what is above the torsion bar, less the wheel.
//
// The wheel alone comes from a record with the hands off (`identify --batch --json WHEEL.json`, given with --wheel), or
// from torque_rim and torque_bar of the same record. Its uncertainty is added to that of the sum: the two records are
// independent, and within one record the wheel is known ten times as well as the arm.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "apps/identification.hpp"

namespace steerid {

struct WheelAlone {
  FittedNumber inertia;      ///< kg m2
  FittedNumber damping;      ///< Nms/rad
  std::string from;          ///< a file, or the two sensors; as it is said
  FittedNumber stiffness{};  ///< Nm/rad, of a spring or a weight below the hands; none above the torsion bar
  FittedNumber friction{};   ///< Nm, dry friction above the torsion bar; 0 where none is stated
  std::string doubt{};       ///< why the answer to its record is not credible; empty where it is
};

/// An answer of `identify` to a record with the hands off: its batch answer, without one the recursive. `equation` is
/// that of the record whose arm is asked for. Throws BadInput, also when the file's equation has another wheel (above
/// the torsion bar, or with the column), when its inertia or damping is not valid, or its stiffness is above the bar,
/// where a wheel without hands has none.
[[nodiscard]] WheelAlone load_wheel(const std::filesystem::path& file, Equation equation);

/// Of a record whose rim and bar agree; nothing otherwise.
[[nodiscard]] std::optional<WheelAlone> wheel_of(const Identification& found);

struct OwnArm {
  IdentifiedParameter inertia_kgm2;
  IdentifiedParameter damping_nms_per_rad;
  IdentifiedParameter stiffness_nm_per_rad;
  WheelAlone wheel;
};

/// Nothing where the wheel is not in what was identified (a rim alone). A parameter keeps its state as long as its
/// deviation is at most a quarter of what is left of it, as in the batch fit; beyond that it is `not excited`.
[[nodiscard]] std::optional<OwnArm> own_arm(const Identification& found, const WheelAlone& wheel);

[[nodiscard]] std::string own_arm_table(const OwnArm& arm);
[[nodiscard]] nlohmann::ordered_json own_arm_json(const OwnArm& arm);

}  // namespace steerid
