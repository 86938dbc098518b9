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

/// Lines of drawn amplitudes in a band, `step_hz` apart, so that their sum comes back after 1/step_hz. It is worked out
/// at every `every`-th sample and joined straight.
struct DrawnLines {
  double low_hz = 0;
  double top_hz = 0;
  double step_hz = 0;
  std::size_t every = 0;
};

/// Adds a torque of that density, Nm^2/Hz.
template <class Density>
void add_drawn(std::vector<double>& torque, const std::vector<double>& time_s, const DrawnLines& drawn,
               const Density& density, Random& random) {
  const auto [low_hz, top_hz, step_hz, every] = drawn;
  struct Line {
    double w, cosine, sine;
  };
  std::vector<Line> lines;
  for (double f = low_hz + step_hz / 2; f < top_hz; f += step_hz) {
    const double sd = std::sqrt(density(f) * step_hz);
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
      torque[k] +=
          from + (to - from) * static_cast<double>(k - i) / static_cast<double>(std::max<std::size_t>(1, next - i));
    }
    from = to;
  }
}

/// The torque that no sensor sees. What is slow comes back after 100 s and is worked out ten times a second, which
/// loses 1 % of the amplitude at 1 Hz; what is faster, as a steering driver's beyond his band, after 20 s.
std::vector<double> drawn_torque(const std::vector<double>& time_s, const NoiseFloor& floor, Random& random) {
  constexpr DrawnLines kSlowLines{.low_hz = 0, .top_hz = 1.5, .step_hz = 0.01, .every = 10};
  constexpr DrawnLines kFastLines{.low_hz = 0, .top_hz = kHighest_hz, .step_hz = 0.05, .every = 1};
  std::vector<double> torque(time_s.size(), 0.0);
  const auto slow = [&](double f_hz) { return floor.slow_variance * floor.slow_colour.density(f_hz); };
  if (floor.slow_variance > 0) {
    DrawnLines lines = floor.lowest_hz > 0 ? kFastLines : kSlowLines;
    lines.low_hz = std::max(floor.lowest_hz - kTransition_hz, 0.0);
    add_drawn(torque, time_s, lines, slow, random);
  }
  if (floor.fast.any()) {
    const auto fast = [&](double f_hz) { return floor.fast.density(Eigen::ArrayXd::Constant(1, f_hz))[0]; };
    add_drawn(torque, time_s, kFastLines, fast, random);
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
    const std::vector<double> unmeasured = drawn_torque(record.time_s, floor, random);
    std::vector<double> noise(unmeasured.size());
    for (std::size_t i = 0; i < unmeasured.size(); ++i) noise[i] = unmeasured[i] + white_nm * random.normal();
    noise = fast_part(std::move(noise), floor.lowest_hz);
    for (std::size_t i = 0; i < unmeasured.size(); ++i) {
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
