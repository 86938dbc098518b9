#include "gap/preparation/driven_band.hpp"

#include <algorithm>
#include <array>
#include <complex>
#include <cstddef>
#include <vector>

#include "gap/likelihood/piece_lines.hpp"

namespace steerid {
namespace {

constexpr double kQuiet_hz = 15;
constexpr double kQuietEnd_hz = 22;

/// Torque and angle together, over a band.
struct Together {
  std::complex<double> cross = 0;
  double torque = 0;
  double angle = 0;

  void add(const std::complex<double>& t, const std::complex<double>& a) {
    cross += t * std::conj(a);
    torque += std::norm(t);
    angle += std::norm(a);
  }
  [[nodiscard]] double coherence() const { return std::norm(cross) / (torque * angle); }
  /// Of what torque and angle could carry, -1 to 1: the sine of the torque's lead. Above 0 the torque drives.
  [[nodiscard]] double power() const { return cross.imag() / std::abs(cross); }
};

/// Of one torque, as it pushes the wheel.
double drives_up_to_hz(const Record& record, const std::vector<double>& torque_nm, double rate_hz) {
  // Coherence: 0.02 by chance in 10 s, and 0.012 at most in 150 open records of a minute.
  constexpr double kClosed = 0.1;
  constexpr double kTakesOut = -0.25;   // 14 degrees: an angle that is 2 ms late at 20 Hz
  constexpr std::size_t kLeast_hz = 4;  // with less there is nothing to tell effects by
  constexpr auto kBands = static_cast<std::size_t>(kHighest_hz);
  std::array<Together, kBands> bands;
  Together quiet;
  const auto visit = [&](const Eigen::VectorXcd& torque, const Eigen::VectorXcd& angle) {
    for (Eigen::Index k = 1; k < angle.size() / 2; ++k) {
      const double hz = rate_hz * static_cast<double>(k) / kPieceRows;
      if (hz < kHighest_hz) bands[static_cast<std::size_t>(hz)].add(torque[k], angle[k]);
      if (hz >= kQuiet_hz && hz < kQuietEnd_hz) quiet.add(torque[k], angle[k]);
    }
  };
  for_each_piece(record, torque_nm, record.angle_rad, visit);
  if (!(quiet.coherence() > kClosed && quiet.power() < kTakesOut)) return kHighest_hz;
  std::size_t end = kBands;
  while (end > kLeast_hz && bands[end - 1].power() < 0) --end;
  return static_cast<double>(end);
}

}  // namespace

double driven_up_to_hz(const Record& record, double rate_hz, double pass_hz) {
  if (kQuietEnd_hz > pass_hz || kQuietEnd_hz > rate_hz / 2) return kHighest_hz;
  std::vector<double> motor_nm = record.torque_motor_nm;
  for (double& torque : motor_nm) torque = -torque;
  double lowest_hz = kHighest_hz;
  for (const std::vector<double>& torque : {record.net_torque_nm(), record.torque_driver_nm, motor_nm}) {
    lowest_hz = std::min(lowest_hz, drives_up_to_hz(record, torque, rate_hz));
  }
  return lowest_hz;
}

}  // namespace steerid
