// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/preparation/lost_samples.hpp"

#include <array>
#include <cstddef>

namespace steerid::gap {
namespace {

/// A rebuilt sample, by what the kept ones around it weigh in it.
struct Rebuilt {
  std::size_t at = 0;
  std::array<std::size_t, 4> from{};
  std::array<double, 4> weight{};  // Lagrange's
};

std::vector<Rebuilt> rebuilt(const std::vector<char>& lost) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < lost.size(); ++i) {
    if (lost[i] == 0) kept.push_back(i);
  }
  std::vector<Rebuilt> all;
  for (std::size_t k = 1; k + 2 < kept.size(); ++k) {
    for (std::size_t i = kept[k] + 1; i < kept[k + 1]; ++i) {
      Rebuilt& one = all.emplace_back(i, std::array{kept[k - 1], kept[k], kept[k + 1], kept[k + 2]});
      for (std::size_t node = 0; node < one.from.size(); ++node) {
        double& weight = one.weight[node] = 1;
        for (std::size_t other = 0; other < one.from.size(); ++other) {
          if (other == node) continue;
          weight *= (static_cast<double>(i) - static_cast<double>(one.from[other])) /
                    (static_cast<double>(one.from[node]) - static_cast<double>(one.from[other]));
        }
      }
    }
  }
  return all;
}

}  // namespace

std::vector<double> over_lost_samples(std::vector<double> angle_rad, const std::vector<char>& lost) {
  for (const Rebuilt& one : rebuilt(lost)) {
    double value = 0;
    for (std::size_t node = 0; node < one.from.size(); ++node) value += one.weight[node] * angle_rad[one.from[node]];
    angle_rad[one.at] = value;
  }
  return angle_rad;
}

Eigen::VectorXd rebuilt_noise_gain(const std::vector<char>& lost, const Eigen::VectorXd& omega_rad_s, double rate_hz) {
  struct Part {
    std::size_t at;
    double weight;
  };
  std::vector<std::vector<Part>> parts(lost.size());  // of every kept sample, in itself and in rebuilt ones
  for (std::size_t i = 0; i < lost.size(); ++i) {
    if (lost[i] == 0) parts[i].push_back({i, 1});
  }
  for (const Rebuilt& one : rebuilt(lost)) {
    for (std::size_t node = 0; node < one.from.size(); ++node) {
      parts[one.from[node]].push_back({one.at, one.weight[node]});
    }
  }
  std::vector<double> covariance;  // of the rebuilt noise, one a distance in samples
  for (const std::vector<Part>& own : parts) {
    for (const Part& a : own) {
      for (const Part& b : own) {
        if (b.at < a.at) continue;
        if (b.at - a.at >= covariance.size()) covariance.resize(b.at - a.at + 1, 0.0);
        covariance[b.at - a.at] += a.weight * b.weight;
      }
    }
  }
  Eigen::VectorXd gain = Eigen::VectorXd::Zero(omega_rad_s.size());
  for (std::size_t lag = 0; lag < covariance.size(); ++lag) {
    const double both_ways = lag == 0 ? 1 : 2;
    gain.array() += both_ways * covariance[lag] / static_cast<double>(lost.size()) *
                    (omega_rad_s.array() * (static_cast<double>(lag) / rate_hz)).cos();
  }
  return gain;
}

double kept_noise_variance(const std::vector<double>& angle_rad, const std::vector<char>& lost) {
  constexpr std::size_t kFewest = 100;
  constexpr double kGain = 1 + (1.0 + 16 + 16 + 1) / 36;  // of the white noise's variance
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 2; i + 2 < angle_rad.size(); ++i) {
    const bool kept = lost[i - 2] == 0 && lost[i - 1] == 0 && lost[i] == 0 && lost[i + 1] == 0 && lost[i + 2] == 0;
    if (!kept) continue;
    const double between = (4 * (angle_rad[i - 1] + angle_rad[i + 1]) - angle_rad[i - 2] - angle_rad[i + 2]) / 6;
    squares += (angle_rad[i] - between) * (angle_rad[i] - between);
    ++count;
  }
  return count < kFewest ? 0 : squares / static_cast<double>(count) / kGain;
}

}  // namespace steerid::gap
