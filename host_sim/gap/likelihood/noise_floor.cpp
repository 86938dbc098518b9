// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/noise_floor.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "gap/hypotheses/hypothesis.hpp"
#include "gap/hypotheses/slow_share.hpp"
#include "gap/likelihood/piece_lines.hpp"
#include "gap/likelihood/student.hpp"
#include "log/resample.hpp"

namespace steerid::gap {
namespace {

constexpr double kQuantum = 1e-12;  // variance below which a channel is a formula, not a measurement

struct Band {
  double low = 0;  ///< of the sampling rate
  double high = 0;
  double sum = 0;
  double lines = 0;

  [[nodiscard]] double mean() const { return sum / lines; }
  [[nodiscard]] double cosine() const { return std::cos(std::numbers::pi * (low + high)); }  ///< of its middle
};

double lowest_of(const std::vector<Band>& bands) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Band& band : bands) {
    if (band.lines > 0) lowest = std::min(lowest, band.mean());
  }
  return std::isfinite(lowest) ? std::max(lowest, kQuantum) : kQuantum;
}

/// What noise with a little colour has where the wheel moves: a line through the bands over cos(2 pi f/rate), as noise
/// of one sample's memory has, and nearly what passed a filter above the drive. The lowest band where that is no line
/// or no slope: something moves in some of them, or the noise is white.
double level_of(const std::vector<Band>& bands) {
  constexpr double kOwn = 0.55;       // share of a windowed, overlapping piece's lines that are its own
  constexpr double kMostOfFit = 9.2;  // chi-square of two degrees of freedom, one in a hundred
  constexpr double kMost = 4;         // times the lowest: a memory of a third
  const double lowest = lowest_of(bands);
  if (bands.size() < 4 || bands.front().lines == 0) return lowest;
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d seen = Eigen::Vector2d::Zero();
  for (const Band& band : bands) {
    const Eigen::Vector2d row(1, band.cosine());
    const double weight = kOwn * band.lines / std::pow(std::max(band.mean(), kQuantum), 2);
    information += weight * row * row.transpose();
    seen += weight * row * band.mean();
  }
  const Eigen::Vector2d line = information.ldlt().solve(seen);
  double misfit = 0;
  for (const Band& band : bands) {
    const double off = band.mean() / (line[0] + line[1] * band.cosine()) - 1;
    misfit += kOwn * band.lines * off * off;
  }
  const double slope_sd = std::sqrt(information.inverse()(1, 1));
  const double level = line.sum();
  return line[1] > kOnceIn370 * slope_sd && misfit < kMostOfFit && level < kMost * lowest ? level : lowest;
}

/// A channel's level; `bound` is what the other channel says that it is at most. What is lower by chance is no bound.
double bounded_level(const std::vector<Band>& channel, const std::vector<Band>& bound) {
  constexpr double kLower = 0.8;
  const double lowest = lowest_of(channel);
  const double level = level_of(channel);
  const double most = lowest_of(bound);
  return level > lowest && most > kLower * lowest ? level : std::min(lowest, most);
}

/// `power(torque line, angle line, w)` in bands of the upper half of the spectrum that end below `pass_hz`.
template <typename Power>
std::vector<Band> above_drive(const std::vector<double>& torque, const std::vector<double>& angle, const Record& record,
                              double pass_hz, const Power& power) {
  // Of what was recorded at 50 Hz only 15 Hz are left: its last bit has to do.
  const double end = std::min(pass_hz / kResampledRateHz, 0.46);
  std::vector<Band> bands = {{0.15, 0.22}, {0.22, 0.30}, {0.30, 0.38}, {0.38, 0.46}};
  std::erase_if(bands, [end](const Band& band) { return band.high > end + 1e-9; });
  if (bands.empty()) bands = {{0.7 * end, 0.85 * end}, {0.85 * end, end}};
  for_each_piece(record, torque, angle, [&](const Eigen::VectorXcd& torque_lines, const Eigen::VectorXcd& angle_lines) {
    for (Band& band : bands) {
      const auto high = static_cast<Eigen::Index>(band.high * kPieceRows);
      for (auto k = static_cast<Eigen::Index>(band.low * kPieceRows); k < high; ++k) {
        const double w = 2 * std::numbers::pi * kResampledRateHz * static_cast<double>(k) / kPieceRows;
        band.sum += power(torque_lines[k], angle_lines[k], w);
        band.lines += 1;
      }
    }
  });
  return bands;
}

}  // namespace

double white_noise_variance(const std::vector<double>& channel, const Record& record, double pass_hz) {
  return level_of(
      above_drive(channel, channel, record, pass_hz, [](Complex line, Complex, double) { return std::norm(line); }));
}

NoiseFloor NoiseFloor::of(const Record& record, const WheelArm& wheel, double pass_hz) {
  const std::vector<double> net = record.net_torque_nm();
  const auto bands = [&](const auto& power) { return above_drive(net, record.angle_rad, record, pass_hz, power); };
  NoiseFloor floor;
  floor.torque_variance =
      bounded_level(bands([](Complex t, Complex, double) { return std::norm(t); }),
                    bands([&](Complex t, Complex a, double w) { return std::norm(t - a / wheel_response(wheel, w)); }));
  floor.angle_variance =
      bounded_level(bands([](Complex, Complex a, double) { return std::norm(a); }),
                    bands([&](Complex t, Complex a, double w) { return std::norm(wheel_response(wheel, w) * t - a); }));
  return floor;
}

namespace {

constexpr double kFirstOrderEnd_hz = 1.0;

/// At one frequency, or at an array of them.
template <class F>
F density_of(const SlowColour& colour, const F& f_hz) {
  using std::abs;
  using std::pow;
  const F x = f_hz / colour.corner_hz;
  const F roll_off = 1.0 + x * x;
  if (!colour.ends) {  // below the corner nobody has seen it: as at the corner
    const F beyond = (x + 1 + abs(x - 1)) / 2;
    return (2 * colour.order - 1) / colour.corner_hz * pow(beyond, -2 * colour.order);
  }
  // The integrals from zero to the end, and to infinity, where there is next to nothing left to be ended.
  if (colour.order == 1) {
    const F square = f_hz * f_hz;
    const F fourth = square * square / std::pow(kFirstOrderEnd_hz, 4);
    const F eighth = fourth * fourth;
    const double power = colour.corner_hz * std::atan(kFirstOrderEnd_hz / colour.corner_hz);
    return 1.0 / (power * roll_off * (1.0 + eighth * eighth));
  }
  const double power = std::numbers::pi * colour.corner_hz / 4;
  return 1.0 / (power * roll_off * roll_off * (1.0 + beyond_the_end(f_hz)));
}

}  // namespace

double SlowColour::density(double f_hz) const { return density_of(*this, f_hz); }
Eigen::ArrayXd SlowColour::density(const Eigen::ArrayXd& f_hz) const { return density_of(*this, f_hz); }

double SlowColour::rate_variance() const {
  if (!ends) return std::pow(2 * std::numbers::pi * corner_hz, 2) * (2 * order - 1) / (2 * order - 3);
  const double ends_at = (order == 1 ? kFirstOrderEnd_hz : kSecondOrderEnd_hz) / corner_hz;
  const double angle = std::atan(ends_at);
  const double mean_square =
      order == 1 ? ends_at / angle - 1 : (angle - ends_at / (1 + ends_at * ends_at)) * 2 / std::numbers::pi;
  return std::pow(2 * std::numbers::pi * corner_hz, 2) * mean_square;
}

double NoiseFloor::slow_top_hz() const { return lowest_hz > 0 ? kHighest_hz : kSlowTop_hz; }

Eigen::ArrayXd NoiseFloor::unmeasured_density(const Eigen::ArrayXd& f_hz) const {
  Eigen::ArrayXd density = Eigen::ArrayXd::Zero(f_hz.size());
  if (slow_variance > 0) density += slow_variance * slow_colour.density(f_hz);
  if (fast.any()) density += fast.density(f_hz);
  return kResampledRateHz / 2 * density;
}

double NoiseFloor::unmeasured_density(double f_hz) const {
  return unmeasured_density(Eigen::ArrayXd::Constant(1, f_hz))[0];
}

Eigen::VectorXd NoiseFloor::density(const BlockSpectra& spectra, const Eigen::VectorXd& gain,
                                    Eigen::Index first) const {
  return density(spectra, gain, gain, first);
}

Eigen::VectorXd NoiseFloor::counted_density(const BlockSpectra& spectra, const Eigen::VectorXd& gain,
                                            Eigen::Index first) const {
  if (spectra.counted_gain().size() == 0 || spectra.torque_noise_share().size() == 0) {
    return density(spectra, gain, first);
  }
  constexpr double kOfNoise = 0.25;  // the share that is left where there was nothing but noise, and its spread
  const auto near = spectra.counted_gain().segment(first, gain.size()).array();
  const auto share = spectra.torque_noise_share().segment(first, gain.size()).array();
  const Eigen::ArrayXd known = ((share - kOfNoise) / (1 - kOfNoise)).max(0.0);
  return density(spectra, gain, known * gain.array() + (1 - known) * near, first);
}

Eigen::VectorXd NoiseFloor::density(const BlockSpectra& spectra, const Eigen::VectorXd& gain,
                                    const Eigen::VectorXd& sensor_gain, Eigen::Index first) const {
  Eigen::VectorXd out(gain.size());
  for (Eigen::Index k = 0; k < gain.size(); ++k) {
    out[k] = angle_density(spectra, first + k) + sensor_gain[k] * torque_density(spectra, first + k);
  }
  if (slow_variance > 0 || fast.any()) {
    const Eigen::ArrayXd f_hz = spectra.omega().segment(first, gain.size()).array() / (2 * std::numbers::pi);
    out.array() += gain.array() * unmeasured_density(f_hz);
  }
  return out;
}

}  // namespace steerid::gap
