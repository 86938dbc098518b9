// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/preparation/known_torque.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>
#include <unsupported/Eigen/FFT>

#include "gap/likelihood/student.hpp"
#include "log/record_quality.hpp"

namespace steerid::gap {
namespace {

constexpr std::size_t kFewest = 400;
constexpr Eigen::Index kAround = 4;  // lines to either side

/// The line from a signal's first samples to its last: without it the jump from the end to the beginning would leak
/// into all lines. None where noise alone makes such a jump: it would stand in lines of which else little is left.
class Trend {
 public:
  Trend(std::span<const double> signal, double variance) {
    constexpr std::size_t kMeanOf = 3;
    const auto mean = [](std::span<const double> part) {
      double sum = 0;
      for (const double value : part) sum += value;
      return sum / static_cast<double>(part.size());
    };
    from_ = mean(signal.first(kMeanOf));
    const double jump = mean(signal.last(kMeanOf)) - from_;
    if (std::abs(jump) < kOnceIn16000 * std::sqrt(2 * variance / kMeanOf)) return;
    rise_ = jump / static_cast<double>(signal.size() - kMeanOf);
  }
  [[nodiscard]] double operator()(std::size_t i) const { return from_ + rise_ * static_cast<double>(i); }

 private:
  double from_ = 0;
  double rise_ = 0;
};

/// The weights of the lines from zero to half the sampling rate.
Eigen::VectorXd weights(const Eigen::VectorXcd& lines, double variance) {
  const Eigen::Index last = lines.size() / 2;
  Eigen::VectorXd weight(last + 1);
  for (Eigen::Index k = 0; k <= last; ++k) {
    const Eigen::Index low = std::max<Eigen::Index>(k - kAround, 1);
    const Eigen::Index high = std::min(k + kAround, last);
    const double around = lines.segment(low, high - low + 1).cwiseAbs2().mean();
    const double power = std::max(around, std::norm(lines[k]));
    weight[k] = power > variance ? 1 - variance / power : 0;
  }
  weight[0] = 1;  // an offset is no noise
  return weight;
}

/// What is left of the noise's power, and of the torque's that is taken for noise, on each line, as a share of the
/// noise's: by drawing, for torques of 0 to 100 times the noise's power, within a tenth of it. The weights stray, since
/// they are known from few lines, so that more is left than the mean of them.
Eigen::VectorXd left_behind(const Eigen::VectorXd& weight) {
  constexpr double kStray = 0.35;
  Eigen::VectorXd left(weight.size());
  for (Eigen::Index k = 0; k < weight.size(); ++k) {
    const Eigen::Index low = std::max<Eigen::Index>(k - kAround, 0);
    const Eigen::Index high = std::min(k + kAround, weight.size() - 1);
    const double mean = weight.segment(low, high - low + 1).mean();
    left[k] = mean * (1 + kStray * (1 - mean));
  }
  return left;
}

/// Leaves of the signal what is known of it, and returns what is left of the noise.
Eigen::VectorXd weigh(std::span<double> signal, double variance) {
  const Trend trend(signal, variance);
  const auto size = static_cast<Eigen::Index>(signal.size());
  Eigen::VectorXd time(size);
  for (std::size_t i = 0; i < signal.size(); ++i) time[static_cast<Eigen::Index>(i)] = signal[i] - trend(i);
  Eigen::FFT<double> transform;
  Eigen::VectorXcd lines;
  transform.fwd(lines, time);
  const Eigen::VectorXd weight = weights(lines / std::sqrt(static_cast<double>(size)), variance);
  for (Eigen::Index k = 0; k < size; ++k) lines[k] *= weight[std::min(k, size - k)];
  transform.inv(time, lines);
  for (std::size_t i = 0; i < signal.size(); ++i) signal[i] = time[static_cast<Eigen::Index>(i)] + trend(i);
  return left_behind(weight);
}

}  // namespace

KnownTorque known_torque(const Record& record, double driver_nm2, double motor_nm2) {
  KnownTorque out{record};
  for (const GapFreeRows& rows : gap_free_rows(record)) {
    if (rows.size() < kFewest) continue;
    const auto of = [&](std::vector<double>& channel, double variance) {
      return weigh(std::span(channel).subspan(rows.begin, rows.size()), variance);
    };
    const Eigen::VectorXd left = driver_nm2 * of(out.record.torque_driver_nm, driver_nm2) +
                                 motor_nm2 * of(out.record.torque_motor_nm, motor_nm2);
    const double all = driver_nm2 + motor_nm2;
    KnownTorque::Left& one = out.left.emplace_back(KnownTorque::Left{rows.begin, rows.end, {}});
    for (const double power : left) one.share.push_back(all > 0 ? power / all : 1.0);
  }
  return out;
}

}  // namespace steerid::gap
