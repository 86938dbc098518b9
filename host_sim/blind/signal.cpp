// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "blind/signal.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <stdexcept>

namespace steerid::blind {

Signal::Signal(std::span<const Tone> tones, double from_s, double to_s) : from_s_(from_s) {
  value_.assign(static_cast<std::size_t>((to_s - from_s) / kStepS) + 4, 0.0);
  constexpr std::size_t kFresh = 1000;  // the phasor is set anew so often that its rounding stays below 1e-12
  for (const Tone& tone : tones) {
    const double w = 2 * std::numbers::pi * tone.frequency_hz;
    const auto turn = std::polar(1.0, w * kStepS);
    std::complex<double> phasor;
    for (std::size_t i = 0; i < value_.size(); ++i) {
      if (i % kFresh == 0)
        phasor = std::polar(tone.amplitude, w * (from_s + kStepS * static_cast<double>(i)) + tone.phase_rad);
      value_[i] += phasor.imag();
      phasor = {phasor.real() * turn.real() - phasor.imag() * turn.imag(),
                phasor.real() * turn.imag() + phasor.imag() * turn.real()};
    }
  }
  fill_slopes();
}

Signal::Signal(const std::function<double(double)>& f, double from_s, double to_s) : from_s_(from_s) {
  value_.resize(static_cast<std::size_t>((to_s - from_s) / kStepS) + 4);
  for (std::size_t i = 0; i < value_.size(); ++i) value_[i] = f(from_s + kStepS * static_cast<double>(i));
  fill_slopes();
}

void Signal::fill_slopes() {
  const std::size_t n = value_.size();
  slope_.assign(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    if (i >= 2 && i + 2 < n) {
      slope_[i] = (8 * (value_[i + 1] - value_[i - 1]) - (value_[i + 2] - value_[i - 2])) / 12;
    } else {
      const std::size_t low = i == 0 ? 0 : i - 1;
      const std::size_t high = std::min(n - 1, i + 1);
      slope_[i] = (value_[high] - value_[low]) / static_cast<double>(high - low);
    }
  }
}

double Signal::at(double time_s) const {
  if (value_.empty()) return 0;
  const double place = std::clamp((time_s - from_s_) / kStepS, 0.0, static_cast<double>(value_.size() - 2));
  const auto i = static_cast<std::size_t>(place);
  const double u = place - static_cast<double>(i);
  const double rise = value_[i + 1] - value_[i];
  return value_[i] +
         u * (slope_[i] + u * (3 * rise - 2 * slope_[i] - slope_[i + 1] + u * (slope_[i] + slope_[i + 1] - 2 * rise)));
}

double Signal::rms() const {
  double sum = 0;
  for (const double v : value_) sum += v * v;
  return value_.empty() ? 0 : std::sqrt(sum / static_cast<double>(value_.size()));
}

Signal& Signal::operator+=(const Signal& other) {
  if (value_.empty()) return *this = other;
  if (other.value_.empty()) return *this;
  if (other.value_.size() != value_.size() || other.from_s_ != from_s_) {
    throw std::logic_error("signals of different spans are added");
  }
  for (std::size_t i = 0; i < value_.size(); ++i) {
    value_[i] += other.value_[i];
    slope_[i] += other.slope_[i];
  }
  return *this;
}

Signal& Signal::operator*=(double factor) {
  for (double& v : value_) v *= factor;
  for (double& s : slope_) s *= factor;
  return *this;
}

}  // namespace steerid::blind
