// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A cubic polynomial of local time: how a signal runs between two ticks.
#pragma once

namespace steerid {

/// value(t0 + tau) = c0 + c1 tau + c2 tau^2 + c3 tau^3, in the signal's unit, tau in seconds.
struct Cubic {
  double c0 = 0;
  double c1 = 0;
  double c2 = 0;
  double c3 = 0;

  [[nodiscard]] constexpr double at(double tau_s) const { return c0 + tau_s * (c1 + tau_s * (c2 + tau_s * c3)); }
  [[nodiscard]] constexpr double slope(double tau_s) const { return c1 + tau_s * (2 * c2 + tau_s * 3 * c3); }

  /// The same polynomial with its origin moved forward by `tau_s`.
  [[nodiscard]] constexpr Cubic shifted(double tau_s) const {
    return {at(tau_s), slope(tau_s), c2 + 3 * c3 * tau_s, c3};
  }

  /// The cubic with these values and slopes at both ends of an interval of `dt_s` (Hermite). A smooth signal differs
  /// from it by at most dt^4/384 times its fourth derivative: 2.5e-5 of a 5 Hz sine at dt = 10 ms, without any delay.
  [[nodiscard]] static constexpr Cubic hermite(double value0, double slope0, double value1, double slope1,
                                               double dt_s) {
    const double secant = (value1 - value0) / dt_s;
    return {value0, slope0, (3 * secant - 2 * slope0 - slope1) / dt_s, (slope0 + slope1 - 2 * secant) / (dt_s * dt_s)};
  }

  /// The cubic through four values at 0, 1/3, 2/3 and the end of an interval of `dt_s`. A smooth signal differs from it
  /// by at most dt^4/1944 times its fourth derivative.
  [[nodiscard]] static constexpr Cubic through(double at0, double at1, double at2, double at3, double dt_s) {
    const double first = at1 - at0;  // divided differences, in thirds of the interval
    const double second = (at2 - 2 * at1 + at0) / 2;
    const double third = (at3 - 3 * at2 + 3 * at1 - at0) / 6;
    const double per = 3 / dt_s;
    return {at0, per * (first - second + 2 * third), per * per * (second - 3 * third), per * per * per * third};
  }

  constexpr Cubic& operator+=(const Cubic& other) {
    c0 += other.c0;
    c1 += other.c1;
    c2 += other.c2;
    c3 += other.c3;
    return *this;
  }
};

constexpr Cubic operator+(Cubic left, const Cubic& right) { return left += right; }
constexpr Cubic operator*(double factor, const Cubic& x) {
  return {factor * x.c0, factor * x.c1, factor * x.c2, factor * x.c3};
}
constexpr Cubic operator-(const Cubic& left, const Cubic& right) { return left + (-1.0) * right; }

}  // namespace steerid
