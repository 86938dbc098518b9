// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/floor_runs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gap/likelihood/fast_part.hpp"
#include "sensors/random.hpp"

namespace steerid::gap {
namespace {

constexpr int kDraws = 6;  // the mean square of one strays by a fifth or so

/// A slow torque of the floor's size and colour: lines of drawn amplitudes that come back after 100 s, worked out ten
/// times a second and joined straight, which loses 1 % of the amplitude at 1 Hz. What a steering driver adds beyond his
/// band is faster: at every sample, and comes back after 20 s.
std::vector<double> drawn_slow_torque(const std::vector<double>& time_s, const NoiseFloor& floor, Random& random) {
  constexpr double kStep_hz = 0.01;
  constexpr double kTop_hz = 1.5;
  constexpr std::size_t kEvery = 10;
  const bool steered = floor.lowest_hz > 0;
  const double step_hz = steered ? 5 * kStep_hz : kStep_hz;
  const double top_hz = steered ? floor.slow_top_hz() : kTop_hz;
  const std::size_t every = steered ? 1 : kEvery;
  std::vector<double> torque(time_s.size(), 0.0);
  if (!(floor.slow_variance > 0)) return torque;
  struct Line {
    double w, cosine, sine;
  };
  std::vector<Line> lines;
  for (double f = std::max(floor.lowest_hz - kTransition_hz, 0.0) + step_hz / 2; f < top_hz; f += step_hz) {
    const double sd = std::sqrt(floor.slow_variance * floor.slow_colour.density(f) * step_hz);
    const double cosine = sd * random.normal();
    lines.push_back({2 * std::numbers::pi * f, cosine, sd * random.normal()});
  }
  const auto at = [&](double t) {
    double sum = 0;
    for (const Line& line : lines) sum += line.cosine * std::cos(line.w * t) + line.sine * std::sin(line.w * t);
    return sum;
  };
  double from = at(time_s.front());
  for (std::size_t i = 0; i < time_s.size(); i += every) {
    const std::size_t next = std::min(i + every, time_s.size() - 1);
    const double to = at(time_s[next]);
    for (std::size_t k = i; k < std::min(i + every, time_s.size()); ++k) {
      torque[k] =
          from + (to - from) * static_cast<double>(k - i) / static_cast<double>(std::max<std::size_t>(1, next - i));
    }
    from = to;
  }
  return torque;
}

}  // namespace

std::optional<double> floor_by_runs_rad(const Simulation& simulation, const Record& record,
                                        const std::vector<RunStretch>& stretches,
                                        const std::vector<double>& undisturbed_rad, const NoiseFloor& floor,
                                        std::uint64_t seed) {
  Random random(seed, 18);
  Record disturbed = record;
  const double white_nm = std::sqrt(floor.torque_variance);
  double squares = 0;
  double count = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const std::vector<double> slow = drawn_slow_torque(record.time_s, floor, random);
    std::vector<double> noise(slow.size());
    for (std::size_t i = 0; i < slow.size(); ++i) noise[i] = slow[i] + white_nm * random.normal();
    noise = fast_part(std::move(noise), floor.lowest_hz);
    for (std::size_t i = 0; i < slow.size(); ++i) {
      disturbed.torque_driver_nm[i] = record.torque_driver_nm[i] + noise[i];
    }
    const std::vector<double> angle = without_drift(restarted_run(simulation, disturbed, stretches), floor.lowest_hz);
    for (std::size_t i = 0; i < angle.size(); ++i) {
      if (std::isnan(undisturbed_rad[i])) continue;
      squares += std::pow(angle[i] - undisturbed_rad[i], 2);
      count += 1;
    }
  }
  const double mean = squares / std::max(count, 1.0);
  if (!std::isfinite(mean)) return std::nullopt;
  return std::sqrt(floor.angle_variance + mean);
}

}  // namespace steerid::gap
