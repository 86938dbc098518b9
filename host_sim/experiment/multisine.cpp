// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "experiment/multisine.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sensors/random.hpp"

namespace steerid {
namespace {

struct Harmonics {
  std::int64_t first;
  std::int64_t last;
  [[nodiscard]] std::int64_t count() const { return last - first + 1; }
};

Harmonics harmonics(const MultisineSettings& settings) {
  constexpr double kRounding = 1e-9;  // 0.2 Hz * 10 s is the second harmonic, whichever way the product rounds
  return {std::max<std::int64_t>(1, std::llround(std::ceil(settings.low_hz * settings.period_s - kRounding))),
          std::llround(std::floor(settings.high_hz * settings.period_s + kRounding))};
}

}  // namespace

Multisine::Multisine(const MultisineSettings& settings) {
  const std::int64_t ticks = std::llround(settings.period_s / kTickS);
  const Harmonics band = harmonics(settings);
  if (!(settings.low_hz > 0.0) || !(settings.high_hz <= 20.0) || !(settings.rms_nm >= 0.0)) {
    throw std::invalid_argument("a multisine needs 0 < low_hz, high_hz <= 20 and rms_nm >= 0");
  }
  if (band.count() < 1) throw std::invalid_argument("no multiple of 1/period_s lies between low_hz and high_hz");

  const auto tones = static_cast<double>(band.count());
  const double amplitude_nm = settings.rms_nm * std::sqrt(2.0 / tones);
  Random random(settings.random_phases.value_or(0));
  period_.resize(static_cast<std::size_t>(ticks));
  for (std::int64_t k = band.first; k <= band.last; ++k) {
    const auto order = static_cast<double>(k - band.first + 1);
    const double phase = settings.random_phases ? 2.0 * std::numbers::pi * random.uniform()
                                                : -std::numbers::pi * order * (order - 1.0) / tones;
    const double rate = 2.0 * std::numbers::pi * static_cast<double>(k) / settings.period_s;
    for (std::int64_t tick = 0; tick < ticks; ++tick) {
      // The whole turns are taken out in integers: cos() of a small angle is exact to the last bit for hours.
      const double turns = static_cast<double>((k * tick) % ticks) / static_cast<double>(ticks);
      const double angle = 2.0 * std::numbers::pi * turns + phase;
      period_[static_cast<std::size_t>(tick)] +=
          SignalPoint{amplitude_nm * std::cos(angle), -amplitude_nm * rate * std::sin(angle)};
    }
  }
}

}  // namespace steerid
