// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A torque as a smooth function of time: tones, tabulated every millisecond and joined by Hermite cubics. What is
// below 10 Hz is kept to a relative 1e-7, at the price of one cubic an evaluation however many tones it has.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace steerid::blind {

struct Tone {
  double amplitude = 0;
  double frequency_hz = 0;
  double phase_rad = 0;
};

class Signal {
 public:
  Signal() = default;  ///< zero everywhere

  /// sum of a sin(2 pi f t + phase) from `from_s` to `to_s`.
  Signal(std::span<const Tone> tones, double from_s, double to_s);
  /// f(t), whose slope is taken from its own table.
  Signal(const std::function<double(double)>& f, double from_s, double to_s);

  [[nodiscard]] double at(double time_s) const;
  /// Root mean square over the table.
  [[nodiscard]] double rms() const;

  Signal& operator+=(const Signal& other);
  Signal& operator*=(double factor);

 private:
  void fill_slopes();

  static constexpr double kStepS = 1e-3;
  double from_s_ = 0;
  std::vector<double> value_;
  std::vector<double> slope_;  // times kStepS
};

}  // namespace steerid::blind
