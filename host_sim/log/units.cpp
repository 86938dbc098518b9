// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/units.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <span>

#include "log/text.hpp"

namespace steerid {
namespace {

struct Unit {
  std::string_view name;
  double per_si;
};

struct Spelling {
  std::string_view written;  ///< as folded() leaves it
  std::string_view name;
};

constexpr double kPoundFeetPerNm = 0.7375621492772656;  // 1 / (0.45359237 * 9.80665 * 0.3048)
constexpr double kKilopondMetresPerNm = 1 / 9.80665;
constexpr double kTurnsPerRad = 0.5 / std::numbers::pi;

constexpr std::array kTimeUnits = {Unit{"s", 1.0}, Unit{"ms", 1e3}, Unit{"us", 1e6}, Unit{"ns", 1e9}};
constexpr std::array kTorqueUnits = {Unit{"nm", 1.0},
                                     Unit{"mnm", 1e3},
                                     Unit{"cnm", 100.0},
                                     Unit{"danm", 0.1},
                                     Unit{"knm", 1e-3},
                                     Unit{"lbft", kPoundFeetPerNm},
                                     Unit{"lbin", 12 * kPoundFeetPerNm},
                                     Unit{"kgfm", kKilopondMetresPerNm},
                                     Unit{"n", 1.0}};
constexpr std::array kAngleUnits = {Unit{"rad", 1.0},  Unit{"deg", kDegreesPerRad}, Unit{"mrad", 1e3},
                                    Unit{"urad", 1e6}, Unit{"turn", kTurnsPerRad},  Unit{"m", 1.0}};

constexpr std::array kTimeSpellings = {Spelling{"sec", "s"},      Spelling{"secs", "s"},        Spelling{"second", "s"},
                                       Spelling{"seconds", "s"},  Spelling{"msec", "ms"},       Spelling{"µs", "us"},
                                       Spelling{"\u03bcs", "us"}, Spelling{"usec", "us"},       Spelling{"nsec", "ns"},
                                       Spelling{"nanos", "ns"},   Spelling{"nanoseconds", "ns"}};
constexpr std::array kTorqueSpellings = {
    Spelling{"ncm", "cnm"},        Spelling{"ftlb", "lbft"}, Spelling{"ftlbf", "lbft"}, Spelling{"lbfft", "lbft"},
    Spelling{"newtonmeter", "nm"}, Spelling{"inlb", "lbin"}, Spelling{"lbfin", "lbin"}, Spelling{"kpm", "kgfm"}};
constexpr std::array kAngleSpellings = {
    Spelling{"°", "deg"},      Spelling{"degree", "deg"},      Spelling{"degrees", "deg"},
    Spelling{"radian", "rad"}, Spelling{"radians", "rad"},     Spelling{"µrad", "urad"},
    Spelling{"meter", "m"},    Spelling{"millirad", "mrad"},   Spelling{"turns", "turn"},
    Spelling{"rev", "turn"},   Spelling{"revs", "turn"},       Spelling{"revolutions", "turn"},
    Spelling{"umdr", "turn"},  Spelling{"umdrehungen", "turn"}};

struct Units {
  std::span<const Unit> units;
  std::span<const Spelling> spellings;
};

Units units_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::kTime:
      return {kTimeUnits, kTimeSpellings};
    case Quantity::kTorque:
      return {kTorqueUnits, kTorqueSpellings};
    case Quantity::kAngle:
      break;
  }
  return {kAngleUnits, kAngleSpellings};
}

/// Lower case, without brackets, blanks and signs of multiplication.
std::string folded(std::string_view unit) {
  std::string out;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    constexpr std::string_view kMiddleDot = "\u00b7";
    constexpr std::string_view kDotOperator = "\u22c5";
    if (unit.substr(i).starts_with(kMiddleDot)) {
      i += kMiddleDot.size() - 1;
    } else if (unit.substr(i).starts_with(kDotOperator)) {
      i += kDotOperator.size() - 1;
    } else if (std::string_view("[](){}<> \t.*-_").find(unit[i]) == std::string_view::npos) {
      out += lower_case(unit[i]);
    }
  }
  return out;
}

const Unit* find_unit(Quantity quantity, std::string_view unit) {
  const Units known = units_of(quantity);
  const std::string text = folded(unit);
  std::string_view name = text;
  for (const Spelling& spelling : known.spellings) {
    if (spelling.written == text) name = spelling.name;
  }
  const auto found = std::ranges::find(known.units, name, &Unit::name);
  return found == known.units.end() ? nullptr : &*found;
}

}  // namespace

std::optional<double> units_per_si(Quantity quantity, std::string_view unit) {
  const Unit* const found = find_unit(quantity, unit);
  return found == nullptr ? std::nullopt : std::optional(found->per_si);
}

bool is_unit(std::string_view unit) {
  return std::ranges::any_of(std::array{Quantity::kTime, Quantity::kTorque, Quantity::kAngle},
                             [&](Quantity quantity) { return find_unit(quantity, unit) != nullptr; });
}

std::string_view plain_unit(Quantity quantity, std::string_view unit) {
  const Unit* const found = find_unit(quantity, unit);
  return found == nullptr ? std::string_view() : found->name;
}

std::string unit_list(Quantity quantity) {
  std::string list;
  for (const Unit& unit : units_of(quantity).units) {
    list += list.empty() ? "" : ", ";
    list += unit.name;
  }
  return list;
}

NameAndUnit split_unit(Quantity quantity, std::string_view column) {
  const std::size_t mark = column.find_last_of("_[(/");
  if (mark == std::string_view::npos) return {column, {}};
  const std::string_view unit = plain_unit(quantity, column.substr(mark + 1));
  if (unit.empty()) return {column, {}};
  return {trimmed(column.substr(0, mark)), unit};
}

}  // namespace steerid
