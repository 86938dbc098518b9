// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/gap_axes.hpp"

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "gap/likelihood/block_spectra.hpp"
#include "gap/likelihood/piece_lines.hpp"
#include "sensors/random.hpp"

namespace steerid::gap {
namespace {

constexpr std::size_t kBins = 8;
constexpr int kDraws = 200;

/// The residual's power by block (rows) and bin (columns), with the samples that make it.
struct Ledger {
  Eigen::MatrixXd power;
  Eigen::MatrixXd samples;
};

Eigen::VectorXd shares(const Eigen::VectorXd& power, const Eigen::VectorXd& samples, double noise) {
  Eigen::VectorXd excess = (power - noise * samples).cwiseMax(0.0);
  const double sum = excess.sum();
  if (sum > 0) return excess / sum;
  return samples / std::max(samples.sum(), 1.0);
}

/// 1 - entropy relative to the expected shares' own: 0 when the gap lies as the samples do.
double concentration(const Eigen::VectorXd& share, const Eigen::VectorXd& expected) {
  double divergence = 0;
  double most = 0;
  for (Eigen::Index i = 0; i < share.size(); ++i) {
    if (expected[i] <= 0) continue;
    if (share[i] > 0) divergence += share[i] * std::log(share[i] / expected[i]);
    most = std::max(most, -std::log(expected[i]));
  }
  return most > 0 ? std::clamp(divergence / most, 0.0, 1.0) : 0;
}

void fill(GapAxis& axis, const Ledger& ledger, double noise) {
  const Eigen::VectorXd power = ledger.power.colwise().sum();
  const Eigen::VectorXd samples = ledger.samples.colwise().sum();
  const Eigen::VectorXd share = shares(power, samples, noise);
  const Eigen::VectorXd expected = samples / std::max(samples.sum(), 1.0);
  const Eigen::Index bins = share.size();
  Random random(20, 3);
  std::vector<std::vector<double>> drawn(static_cast<std::size_t>(bins));
  const Eigen::Index blocks = ledger.power.rows();
  for (int d = 0; d < kDraws; ++d) {
    Eigen::VectorXd p = Eigen::VectorXd::Zero(bins);
    Eigen::VectorXd s = Eigen::VectorXd::Zero(bins);
    for (Eigen::Index b = 0; b < blocks; ++b) {
      const auto pick = static_cast<Eigen::Index>(random.uniform() * static_cast<double>(blocks));
      p += ledger.power.row(pick);
      s += ledger.samples.row(pick);
    }
    const Eigen::VectorXd one = shares(p, s, noise);
    for (Eigen::Index i = 0; i < bins; ++i) drawn[static_cast<std::size_t>(i)].push_back(one[i]);
  }
  for (Eigen::Index i = 0; i < bins; ++i) {
    std::vector<double>& all = drawn[static_cast<std::size_t>(i)];
    std::ranges::sort(all);
    GapBin& bin = axis.bins[static_cast<std::size_t>(i)];
    bin.share = {share[i], all[all.size() / 40], all[all.size() - 1 - all.size() / 40]};
    bin.expected_share = expected[i];
  }
  axis.concentration = concentration(share, expected);
}

/// Along a quantity that every sample has; bins of equally many samples, or equally wide ones.
GapAxis along(const char* name, const char* unit, const std::vector<double>& value, const std::vector<double>& torque,
              double noise, bool even) {
  GapAxis axis{.axis = name, .unit = unit};
  std::vector<double> sorted = value;
  std::ranges::sort(sorted);
  std::vector<double> edges;
  for (std::size_t i = 0; i <= kBins; ++i) {
    const double part = static_cast<double>(i) / kBins;
    const auto at = std::min(sorted.size() - 1, i * sorted.size() / kBins);
    edges.push_back(even ? sorted.front() + part * (sorted.back() - sorted.front()) : sorted[at]);
  }
  for (std::size_t i = 0; i < kBins; ++i) axis.bins.push_back({.low = edges[i], .high = edges[i + 1]});
  const auto blocks = static_cast<Eigen::Index>((value.size() + kPieceRows - 1) / kPieceRows);
  Ledger ledger{Eigen::MatrixXd::Zero(blocks, kBins), Eigen::MatrixXd::Zero(blocks, kBins)};
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (!std::isfinite(torque[i])) continue;
    const auto above = std::ranges::upper_bound(edges.begin() + 1, edges.end() - 1, value[i]) - edges.begin() - 1;
    const auto block = static_cast<Eigen::Index>(i / kPieceRows);
    ledger.power(block, above) += torque[i] * torque[i];
    ledger.samples(block, above) += 1;
  }
  fill(axis, ledger, noise);
  return axis;
}

std::vector<double> swing(const std::vector<double>& angle) {
  constexpr std::size_t kReach = 100;
  std::vector<double> out(angle.size());
  for (std::size_t i = 0; i < angle.size(); ++i) {
    const std::size_t from = i > kReach ? i - kReach : 0;
    const std::size_t to = std::min(angle.size(), i + kReach);
    if (i % 10 == 0) {  // slow: every tenth of a second will do
      const auto [low, high] = std::minmax_element(angle.begin() + static_cast<std::ptrdiff_t>(from),
                                                   angle.begin() + static_cast<std::ptrdiff_t>(to));
      out[i] = (*high - *low) / 2;
    } else {
      out[i] = out[i - 1];
    }
  }
  return out;
}

std::vector<double> since_reversal(const MeasuredMotion& motion) {
  std::vector<double> out(motion.rate_rad_s.size(), 0.0);
  double last = motion.time_s.front();
  for (std::size_t i = 1; i < out.size(); ++i) {
    if ((motion.rate_rad_s[i] >= 0) != (motion.rate_rad_s[i - 1] >= 0)) last = motion.time_s[i];
    out[i] = motion.time_s[i] - last;
  }
  return out;
}

GapAxis along_frequency(const ResidualSpectrum& spectrum) {
  GapAxis axis{.axis = "frequency", .unit = "Hz"};
  constexpr std::array kEdges = {0.0, 0.15, 0.35, 0.75, 1.5, 3.0, 5.0, 8.0, kHighest_hz};
  const auto bins = static_cast<Eigen::Index>(kEdges.size()) - 1;
  Eigen::VectorXd power = Eigen::VectorXd::Zero(bins);
  Eigen::VectorXd noise = Eigen::VectorXd::Zero(bins);
  Eigen::VectorXd lines = Eigen::VectorXd::Zero(bins);
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(bins);
  for (std::size_t k = 0; k < spectrum.frequency_hz.size(); ++k) {
    const auto bin = std::ranges::upper_bound(kEdges, spectrum.frequency_hz[k]) - kEdges.begin() - 1;
    if (bin >= bins) break;
    power[bin] += spectrum.refit_rad2_per_hz[k];
    noise[bin] += spectrum.noise_rad2_per_hz[k];
    lines[bin] += 1;
    motion[bin] += spectrum.measured_rad2_per_hz[k];
  }
  const Eigen::VectorXd excess = (power - noise).cwiseMax(0.0);
  const double sum = excess.sum();
  const Eigen::VectorXd expected = noise / std::max(noise.sum(), 1e-300);
  const Eigen::VectorXd share = sum > 0 ? Eigen::VectorXd(excess / sum) : expected;
  for (Eigen::Index i = 0; i < bins; ++i) {
    // A mean over lines and pieces of exponential variables: its relative sd is one over the root of their number.
    const double sd = lines[i] > 0 ? share[i] * (1 - share[i]) * 2 / std::sqrt(4 * lines[i]) : 0;
    axis.bins.push_back({.low = kEdges[static_cast<std::size_t>(i)],
                         .high = kEdges[static_cast<std::size_t>(i) + 1],
                         .share = {share[i], std::max(0.0, share[i] - 1.96 * sd), std::min(1.0, share[i] + 1.96 * sd)},
                         .expected_share = expected[i]});
  }
  // A wheel moves slowly, and so does whatever it gets wrong: the gap is concentrated where it exceeds the motion's own
  // share. One part in fifty is granted to every band, lest a band in which nothing moves decides.
  constexpr double kGranted = 0.02;
  motion = motion.array() / std::max(motion.sum(), 1e-300) + kGranted;
  axis.concentration = concentration(share, motion / motion.sum());
  return axis;
}

/// What the residual torque follows, in least squares by block: value and slope of one channel after the other.
GapAxis along_channel(const Record& record, const MeasuredMotion& motion, const std::vector<double>& torque,
                      double noise) {
  const char* opposing = record.motor_channel == kTorqueBarValid   ? "torsion bar's torque"
                         : record.motor_channel == kTorqueRimValid ? "rim's torque"
                                                                   : "motor's torque";
  GapAxis axis{.axis = "channel", .unit = "", .bin_names = {"driver's torque", opposing, "angle", "none of them"}};
  const std::size_t n = torque.size();
  const auto rows = static_cast<Eigen::Index>(n);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(rows, 6);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    columns.row(row) << record.torque_driver_nm[i], record.torque_driver_nm[i + 1] - record.torque_driver_nm[i - 1],
        record.torque_motor_nm[i], record.torque_motor_nm[i + 1] - record.torque_motor_nm[i - 1], motion.angle_rad[i],
        motion.rate_rad_s[i];
  }
  Eigen::VectorXd rest = Eigen::Map<const Eigen::VectorXd>(torque.data(), rows);
  const auto blocks = static_cast<Eigen::Index>((n + kPieceRows - 1) / kPieceRows);
  Ledger ledger{Eigen::MatrixXd::Zero(blocks, 4), Eigen::MatrixXd::Zero(blocks, 4)};
  for (Eigen::Index channel = 0; channel < 4; ++channel) {
    Eigen::VectorXd explained = rest;
    if (channel < 3) {
      const Eigen::MatrixXd own = columns.middleCols(2 * channel, 2);
      explained = own * own.completeOrthogonalDecomposition().solve(rest);
      rest -= explained;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const auto block = static_cast<Eigen::Index>(i / kPieceRows);
      ledger.power(block, channel) += std::pow(explained[static_cast<Eigen::Index>(i)], 2);
      ledger.samples(block, channel) += channel == 3 ? 1.0 : 1e-3;  // noise follows nothing
    }
  }
  for (int channel = 0; channel < 4; ++channel) {
    axis.bins.push_back({.low = static_cast<double>(channel), .high = static_cast<double>(channel) + 1});
  }
  fill(axis, ledger, noise);
  // "None of them" is where everything unexplained goes: it does not place the gap.
  const double placed = 1 - axis.bins[3].share.value;
  axis.concentration = placed > 0.6 ? 0.5 * placed : 0;
  return axis;
}

}  // namespace

std::vector<GapAxis> gap_axes(const Record& record, const MeasuredMotion& motion, const GapSeries& series,
                              const ResidualSpectrum& spectrum, double noise_nm2) {
  const std::vector<double>& torque = series.torque_residual_nm;
  std::vector<GapAxis> axes;
  axes.push_back(along("velocity", "rad/s", motion.rate_rad_s, torque, noise_nm2, false));
  axes.push_back(along("position", "rad", motion.angle_rad, torque, noise_nm2, false));
  axes.push_back(along("time", "s", motion.time_s, torque, noise_nm2, true));
  axes.push_back(along_frequency(spectrum));
  axes.push_back(along("amplitude", "rad", swing(motion.angle_rad), torque, noise_nm2, false));
  axes.push_back(along("reversal", "s", since_reversal(motion), torque, noise_nm2, false));
  axes.push_back(along_channel(record, motion, torque, noise_nm2));
  std::ranges::stable_sort(axes, [](const GapAxis& a, const GapAxis& b) { return a.concentration > b.concentration; });
  return axes;
}

}  // namespace steerid::gap
