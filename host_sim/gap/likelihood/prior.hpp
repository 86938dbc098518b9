// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What is known of a number before a record is looked at: minus the log of its density, up to a constant.
//
//   normal:                u^2 / 2,        u = (x - mean) / sd
//   of a given size:       log(1 + u^2),   u = log(x / mean) / sd      Cauchy's law of the logarithm
//
// The second is that of a simulation's J, B and C: off by a few per cent as a rule, and by any amount now and then. Its
// pull on a number that a record tells fades with the distance; along a ridge, where a record tells nothing, it is what
// decides.
#pragma once

namespace steerid::gap {

/// Relative error that a simulation's J, B and C usually have.
inline constexpr double kUsualError = 0.06;

struct Prior {
  enum class Law { kNone, kNormal, kOfGivenSize };
  Law law = Law::kNone;
  double mean = 0;
  double sd = 0;  ///< in units of the number; of a given size relative

  /// Of one of a simulation's J, B and C; none where it has none of it.
  [[nodiscard]] static Prior of_given(double given) {
    return given > 0 ? Prior{Law::kOfGivenSize, given, kUsualError} : Prior{};
  }
  /// None where the deviation is 0.
  [[nodiscard]] static Prior normal(double mean, double sd) { return sd > 0 ? Prior{Law::kNormal, mean, sd} : Prior{}; }

  [[nodiscard]] explicit operator bool() const { return law != Law::kNone; }
  /// What a value costs, nats.
  [[nodiscard]] double cost(double x) const;
  /// Derivative of the cost.
  [[nodiscard]] double slope(double x) const;
  /// Second derivative that a Gauss-Newton step takes: never negative. Of Cauchy's law that of the parabola which
  /// touches the cost from above (Dempster, Laird and Rubin, 1980: iteratively reweighted least squares).
  [[nodiscard]] double weight(double x) const;
};

}  // namespace steerid::gap
