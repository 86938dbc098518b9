#include "gap/noise_floor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "log/record_quality.hpp"

namespace steerid {
namespace {

constexpr double kQuantum = 1e-12;  // variance below which a channel is a formula, not a measurement

/// Mean periodogram in bands of the upper half of the spectrum, over Hann-windowed pieces; the lowest band counts.
double white_level(std::span<const double> signal, std::span<const GapFreeRows> stretches) {
  constexpr std::size_t kPiece = 200;
  constexpr std::array<std::array<double, 2>, 4> kBands = {{{0.15, 0.22}, {0.22, 0.30}, {0.30, 0.38}, {0.38, 0.46}}};
  std::array<double, kBands.size()> power{};
  std::array<double, kBands.size()> bins{};
  Eigen::FFT<double> transform;
  Eigen::VectorXd window(kPiece);
  for (std::size_t i = 0; i < kPiece; ++i) {
    const double s = std::sin(std::numbers::pi * (static_cast<double>(i) + 0.5) / kPiece);
    window[static_cast<Eigen::Index>(i)] = s * s * s * s;  // side lobes fall fast: the drive is 60 dB above the noise
  }
  const double energy = window.squaredNorm();
  Eigen::VectorXd piece(kPiece);
  Eigen::VectorXcd lines;
  for (const GapFreeRows& rows : stretches) {
    for (std::size_t first = rows.begin; first + kPiece <= rows.end; first += kPiece / 2) {
      piece = Eigen::Map<const Eigen::VectorXd>(signal.data() + first, kPiece);
      piece.array() -= piece.mean();
      piece.array() *= window.array();
      transform.fwd(lines, piece);
      for (std::size_t b = 0; b < kBands.size(); ++b) {
        const auto low = static_cast<Eigen::Index>(kBands[b][0] * kPiece);
        const auto high = static_cast<Eigen::Index>(kBands[b][1] * kPiece);
        for (Eigen::Index k = low; k < high; ++k) {
          power[b] += std::norm(lines[k]) / energy;
          bins[b] += 1;
        }
      }
    }
  }
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < kBands.size(); ++b) {
    if (bins[b] > 0) lowest = std::min(lowest, power[b] / bins[b]);
  }
  return std::isfinite(lowest) ? std::max(lowest, kQuantum) : kQuantum;
}

}  // namespace

double white_noise_variance(const std::vector<double>& channel, const Record& record) {
  return white_level(channel, gap_free_rows(record));
}

NoiseFloor NoiseFloor::of(const Record& record, double rate_hz) {
  NoiseFloor floor;
  floor.rate_hz = rate_hz;
  const std::vector<GapFreeRows> stretches = gap_free_rows(record);
  floor.angle_variance = white_level(record.angle_rad, stretches);
  std::vector<double> net(record.size());
  for (std::size_t i = 0; i < record.size(); ++i) net[i] = record.net_torque_nm(i);
  floor.torque_variance = white_level(net, stretches);
  return floor;
}

double NoiseFloor::slow_shape(double f_hz) const {
  const double x = f_hz / slow_corner_hz;
  constexpr double kEnd_hz = 1.3;
  return rate_hz / 2 * 4 / (std::numbers::pi * slow_corner_hz) /
         ((1 + x * x) * (1 + x * x) * (1 + std::pow(f_hz / kEnd_hz, 6)));
}

Eigen::VectorXd NoiseFloor::density(const Eigen::VectorXd& omega, const Eigen::VectorXd& gain) const {
  Eigen::VectorXd out(omega.size());
  for (Eigen::Index k = 0; k < omega.size(); ++k) {
    const double slow = slow_variance > 0 ? slow_variance * slow_shape(omega[k] / (2 * std::numbers::pi)) : 0;
    out[k] = angle_variance + gain[k] * (torque_variance + slow);
  }
  return out;
}

}  // namespace steerid
