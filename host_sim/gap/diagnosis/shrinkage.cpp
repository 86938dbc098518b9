// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/shrinkage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "gap/hypotheses/slow_share.hpp"
#include "gap/likelihood/band_mean.hpp"
#include "gap/likelihood/student.hpp"
#include "gap/model/floor_rms.hpp"
#include "sensors/random.hpp"

namespace steerid::gap {
namespace {

constexpr double kNothing = 1e-12;

/// Sums of squares over one piece of the held-out part.
struct Piece {
  double samples = 0;
  double sim = 0;
  double refit = 0;
  double with_effect = 0;
};

/// Longer than the slow torque remembers, some 1/(2 pi 0.1 Hz); a block of a short record is one piece.
constexpr double kPiece_s = 2.5;

std::vector<Piece> held_out_pieces(const ShrinkageInput& in) {
  const std::size_t length = std::max<std::size_t>(
      20, static_cast<std::size_t>(kPiece_s / std::max(1e-3, in.record.time_s[1] - in.record.time_s[0])));
  std::vector<Piece> pieces;
  for (const Block& block : in.blocks) {
    if (block.role != Block::Role::kReport) continue;
    for (std::size_t from = 0; from < block.count; from += length) {
      Piece piece;
      for (std::size_t i = block.first + from; i < block.first + std::min(block.count, from + length); ++i) {
        if (in.every_second && i % 2 == 0) continue;
        const double angle = in.record.angle_rad[i];
        piece.samples += 1;
        piece.sim += std::pow(angle - in.sim_rad[i], 2);
        piece.refit += std::pow(angle - in.refit_rad[i], 2);
        piece.with_effect += std::pow(angle - in.with_effect_rad[i], 2);
      }
      if (piece.samples > 0) pieces.push_back(piece);
    }
  }
  return pieces;
}

Piece total(const std::vector<Piece>& pieces) {
  Piece sum;
  for (const Piece& one : pieces) {
    sum.samples += one.samples;
    sum.sim += one.sim;
    sum.refit += one.refit;
    sum.with_effect += one.with_effect;
  }
  return sum;
}

bool shows_gap(double refit, double floor) { return refit > (1 + kFloorKnownTo) * floor && refit - floor > kNothing; }

double closed(double refit, double with_effect, double floor) { return (refit - with_effect) / (refit - floor); }

/// The tail of the bootstrap's draws that a two-sided 95 % interval cuts off. Draws of few pieces spread less than what
/// they stand for, by the root of (n - 1)/n, and have normal tails where Student's belong: the quantile that makes up
/// for both is the normal distribution's at -sqrt(n/(n - 1)) t (Hesterberg, What teachers should know about the
/// bootstrap, 2015, section 4.3). Of ten pieces it is 0.9 % and not 2.5 %.
double expanded_tail(std::size_t pieces) {
  const double free = std::max(2.0, static_cast<double>(pieces) - 1);
  return std::erfc(std::sqrt((free + 1) / free) * student95(free) / std::numbers::sqrt2) / 2;
}

/// The band of the angle that the unmeasured torque leaves, Hz: (integral of S)^2 over the integral of S^2. Its mean
/// square over T seconds has 2 T times so many degrees of freedom (Bendat and Piersol, Random Data, section 8.2).
double slow_band_hz(const NoiseFloor& floor, const std::function<double(double)>& gain) {
  const auto density = [&](double f_hz) { return gain(2 * std::numbers::pi * f_hz) * floor.unmeasured_density(f_hz); };
  const double mean = band_mean(floor.lowest_hz, kHighest_hz, density);
  const double mean_square =
      band_mean(floor.lowest_hz, kHighest_hz, [&](double f_hz) { return std::pow(density(f_hz), 2); });
  return (kHighest_hz - floor.lowest_hz) * (mean_square > 0 ? mean * mean / mean_square : 1);
}

/// Samples that were held out over those that were seen.
double held_out_over_seen(const std::vector<Block>& blocks) {
  double held_out = 0;
  double seen = 0;
  for (const Block& block : blocks) {
    (block.role == Block::Role::kReport ? held_out : seen) += static_cast<double>(block.count);
  }
  return held_out / seen;
}

}  // namespace

double held_out_sd(const Record& record, const std::vector<Block>& blocks) {
  double sum = 0;
  double squares = 0;
  double count = 0;
  for (const Block& block : blocks) {
    if (block.role != Block::Role::kReport) continue;
    for (std::size_t i = block.first; i < block.first + block.count; ++i) {
      sum += record.angle_rad[i];
      squares += record.angle_rad[i] * record.angle_rad[i];
      count += 1;
    }
  }
  return std::sqrt(std::max(squares / count - std::pow(sum / count, 2), kNothing));
}

GapSizes shrinkage(const ShrinkageInput& in) {
  GapSizes sizes;
  const std::vector<Piece> pieces = held_out_pieces(in);
  const double sd = held_out_sd(in.record, in.blocks);
  const Piece all = total(pieces);
  const auto nrmse = [sd](double squares, double samples) { return std::sqrt(squares / samples) / sd; };
  sizes.sim_nrmse = nrmse(all.sim, all.samples);
  sizes.refit_nrmse = nrmse(all.refit, all.samples);
  sizes.with_effect_nrmse = nrmse(all.with_effect, all.samples);
  sizes.floor_nrmse = in.floor_rad.value_or(floor_rms_rad(in.floor, in.gain, in.quantum_rad)) / sd;
  sizes.closed_fraction.value = shows_gap(sizes.refit_nrmse, sizes.floor_nrmse)
                                    ? closed(sizes.refit_nrmse, sizes.with_effect_nrmse, sizes.floor_nrmse)
                                    : std::numeric_limits<double>::quiet_NaN();

  // The floor is an expectation, estimated on the part that was seen; how far the held-out part strays from it is
  // mostly the slow torque's doing.
  NoiseFloor sensors = in.floor;
  sensors.slow_variance = 0;
  sensors.fast = {};
  const double both = sizes.floor_nrmse * sizes.floor_nrmse;
  const double quick = std::min(both, std::pow(floor_rms_rad(sensors, in.gain, in.quantum_rad) / sd, 2));
  const double slow = both - quick;
  const double seconds = std::max(2.0, all.samples * (in.record.time_s[1] - in.record.time_s[0]));
  const double of_both = 1 + held_out_over_seen(in.blocks);  // the floor was read off the part that was seen
  const double slow_sd = std::sqrt(of_both / (slow_band_hz(in.floor, in.gain) * seconds));
  const double quick_sd = std::sqrt(of_both * 2 / all.samples);
  Random random(in.seed, 17);
  // What is left holds the noise, so that no floor above it can be: the fraction's ends stay at or below one. Its upper
  // end is what the effect closes with its numbers known.
  // Where the noise alone may have made the refit's error, by more than a chance of the tail, no gap is shown. A gap in
  // a part of the record is missing in some draws of pieces, which say nothing of what closes it.
  std::vector<double> least;
  std::vector<double> most;
  int without_gap = 0;
  std::vector<Piece> drawn(pieces.size());
  for (int d = 0; d < in.draws && !pieces.empty(); ++d) {
    for (Piece& piece : drawn) {
      piece = pieces[static_cast<std::size_t>(random.uniform() * static_cast<double>(pieces.size()))];
    }
    const Piece sum = total(drawn);
    const double left = nrmse(sum.with_effect, sum.samples);
    const double refit = nrmse(sum.refit, sum.samples);
    const double noise =
        std::sqrt(quick * std::exp(quick_sd * random.normal()) + slow * std::exp(slow_sd * random.normal()));
    if (!shows_gap(sizes.refit_nrmse, noise)) ++without_gap;
    const double floor = std::min(left, noise);
    const std::size_t count = in.unsure_rad2.size();
    const double unsure = count > 0 ? in.unsure_rad2[static_cast<std::size_t>(d) % count] / (sd * sd) : 0;
    const double known = std::sqrt(std::max(left * left - unsure, floor * floor));
    if (!shows_gap(refit, floor)) continue;
    least.push_back(closed(refit, left, floor));
    most.push_back(closed(refit, known, floor));
  }
  BoundedValue& fraction = sizes.closed_fraction;
  const double tail = expanded_tail(pieces.size());
  if (least.size() < 20 || without_gap > tail * in.draws) {
    using Limits = std::numeric_limits<double>;
    fraction = {Limits::quiet_NaN(), -Limits::infinity(), Limits::infinity()};
    return sizes;
  }
  std::ranges::sort(least);
  std::ranges::sort(most);
  const auto cut = static_cast<std::size_t>(tail * static_cast<double>(least.size()));
  fraction.low = std::min(fraction.value, least[cut]);
  fraction.high = std::max(fraction.value, most[most.size() - 1 - cut]);
  return sizes;
}

}  // namespace steerid::gap
