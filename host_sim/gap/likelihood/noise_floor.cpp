#include "gap/likelihood/noise_floor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "gap/hypotheses/hypothesis.hpp"
#include "gap/likelihood/piece_lines.hpp"

namespace steerid {
namespace {

constexpr double kQuantum = 1e-12;  // variance below which a channel is a formula, not a measurement

/// Mean of `power(torque line, angle line, w)` in bands of the upper half of the spectrum that end below `pass_hz`; the
/// lowest band counts.
template <typename Power>
double lowest_band(const std::vector<double>& torque, const std::vector<double>& angle, const Record& record,
                   double rate_hz, double pass_hz, const Power& power) {
  // Of what was recorded at 50 Hz only 15 Hz are left: its last bit has to do.
  const double end = std::min(pass_hz / rate_hz, 0.46);
  std::vector<std::array<double, 2>> bands = {{0.15, 0.22}, {0.22, 0.30}, {0.30, 0.38}, {0.38, 0.46}};
  std::erase_if(bands, [end](const auto& band) { return band[1] > end + 1e-9; });
  if (bands.empty()) bands = {{0.7 * end, 0.85 * end}, {0.85 * end, end}};
  std::vector<double> sum(bands.size());
  std::vector<double> bins(bands.size());
  for_each_piece(record, torque, angle, [&](const Eigen::VectorXcd& torque_lines, const Eigen::VectorXcd& angle_lines) {
    for (std::size_t b = 0; b < bands.size(); ++b) {
      const auto high = static_cast<Eigen::Index>(bands[b][1] * kPieceRows);
      for (auto k = static_cast<Eigen::Index>(bands[b][0] * kPieceRows); k < high; ++k) {
        const double w = 2 * std::numbers::pi * rate_hz * static_cast<double>(k) / kPieceRows;
        sum[b] += power(torque_lines[k], angle_lines[k], w);
        bins[b] += 1;
      }
    }
  });
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < bands.size(); ++b) {
    if (bins[b] > 0) lowest = std::min(lowest, sum[b] / bins[b]);
  }
  return std::isfinite(lowest) ? std::max(lowest, kQuantum) : kQuantum;
}

}  // namespace

double white_noise_variance(const std::vector<double>& channel, const Record& record, double pass_hz) {
  return lowest_band(channel, channel, record, 100, pass_hz,
                     [](Complex line, Complex, double) { return std::norm(line); });
}

NoiseFloor NoiseFloor::of(const Record& record, const WheelArm& wheel, double rate_hz, double pass_hz) {
  const std::vector<double> net = record.net_torque_nm();
  const auto lowest = [&](const auto& power) {
    return lowest_band(net, record.angle_rad, record, rate_hz, pass_hz, power);
  };
  NoiseFloor floor;
  floor.rate_hz = rate_hz;
  floor.torque_variance =
      std::min(lowest([](Complex t, Complex, double) { return std::norm(t); }),
               lowest([&](Complex t, Complex a, double w) { return std::norm(t - a / wheel_response(wheel, w)); }));
  floor.angle_variance =
      std::min(lowest([](Complex, Complex a, double) { return std::norm(a); }),
               lowest([&](Complex t, Complex a, double w) { return std::norm(wheel_response(wheel, w) * t - a); }));
  return floor;
}

namespace {

constexpr double kFirstOrderEnd_hz = 1.0;
constexpr double kSecondOrderEnd_hz = 1.3;

double cube(double x) { return x * x * x; }
double eighth(double x) {
  const double fourth = x * x * x * x;
  return fourth * fourth;
}

}  // namespace

double SlowColour::density(double f_hz) const {
  const double x = f_hz / corner_hz;
  const double roll_off = 1 + x * x;
  // The integrals from zero to the end, and to infinity, where there is next to nothing left to be ended.
  if (order == 1) {
    const double end = 1 + eighth(f_hz * f_hz / (kFirstOrderEnd_hz * kFirstOrderEnd_hz));
    return 1 / (corner_hz * std::atan(kFirstOrderEnd_hz / corner_hz) * roll_off * end);
  }
  const double end = 1 + cube(f_hz * f_hz / (kSecondOrderEnd_hz * kSecondOrderEnd_hz));
  return 4 / (std::numbers::pi * corner_hz * roll_off * roll_off * end);
}

double SlowColour::rate_variance() const {
  const double ends_at = (order == 1 ? kFirstOrderEnd_hz : kSecondOrderEnd_hz) / corner_hz;
  const double angle = std::atan(ends_at);
  const double mean_square =
      order == 1 ? ends_at / angle - 1 : (angle - ends_at / (1 + ends_at * ends_at)) * 2 / std::numbers::pi;
  return std::pow(2 * std::numbers::pi * corner_hz, 2) * mean_square;
}

double NoiseFloor::slow_shape(double f_hz) const { return rate_hz / 2 * slow_colour.density(f_hz); }

Eigen::VectorXd NoiseFloor::density(const BlockSpectra& spectra, const Eigen::VectorXd& gain) const {
  const Eigen::VectorXd& omega = spectra.omega();
  Eigen::VectorXd out(omega.size());
  for (Eigen::Index k = 0; k < omega.size(); ++k) {
    const double slow = slow_variance > 0 ? slow_variance * slow_shape(omega[k] / (2 * std::numbers::pi)) : 0;
    out[k] = angle_density(spectra, k) + gain[k] * (torque_variance + slow);
  }
  return out;
}

}  // namespace steerid
