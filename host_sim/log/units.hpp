// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The units that a log may have its channels in, and how files write them.
//
// | quantity | SI  | units                                   | also written                                        |
// | time     | s   | s, ms, us, ns                           | sec, seconds, msec, µs                              |
// | torque   | nm  | nm, mnm, cnm, danm, knm, lbft, lbin,    | N·m, N*m, [Nm], Ncm, ft-lb; n: newtons of a slide   |
// |          |     | kgfm, n                                 |                                                     |
// | angle    | rad | rad, deg, mrad, urad, turn, m           | radians, degrees, °, rev; m: metres of a slide      |
//
// Case, brackets, spaces, dots and stars are ignored. A linear drive is read with newtons and metres in place of newton
// metres and radians; its J is then a mass in kg.
#pragma once

#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

namespace steerid {

inline constexpr double kDegreesPerRad = 180.0 / std::numbers::pi;

enum class Quantity : std::uint8_t { kTime, kTorque, kAngle };

/// How many of `unit` make one SI unit of the quantity (1000 for "ms"); nothing when it is no unit of it.
[[nodiscard]] std::optional<double> units_per_si(Quantity quantity, std::string_view unit);

/// The quantity's units as --columns names them, for a sentence: "s, ms, us, ns".
[[nodiscard]] std::string unit_list(Quantity quantity);

/// A unit of any of the quantities.
[[nodiscard]] bool is_unit(std::string_view unit);

/// As --columns names what a file writes: "deg" for "[°]"; empty when it is no unit of the quantity.
[[nodiscard]] std::string_view plain_unit(Quantity quantity, std::string_view unit);

/// A column's name without the unit behind it, and that unit: "Angle [deg]" is "Angle" and "deg", "t_ms" is "t" and
/// "ms". The unit is empty where the name states none of the quantity.
struct NameAndUnit {
  std::string_view name;
  std::string_view unit;
};
[[nodiscard]] NameAndUnit split_unit(Quantity quantity, std::string_view column);

}  // namespace steerid
