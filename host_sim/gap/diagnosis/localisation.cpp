// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/localisation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "gap/diagnosis/gap_axes.hpp"
#include "gap/diagnosis/residual_spectrum.hpp"
#include "gap/hypotheses/measured_motion.hpp"
#include "log/reading_time.hpp"

namespace steerid::gap {
namespace {

/// Bins of the angle-velocity map along either, over the middle 99 % of what was visited.
constexpr std::size_t kMapBins = 12;

std::vector<double> even_edges(std::vector<double> values, std::size_t bins) {
  std::ranges::sort(values);
  const double low = values[values.size() / 200];
  const double high = values[values.size() - 1 - values.size() / 200];
  std::vector<double> edges;
  for (std::size_t i = 0; i <= bins; ++i) {
    edges.push_back(low + (high - low) * static_cast<double>(i) / static_cast<double>(bins));
  }
  return edges;
}

std::ptrdiff_t bin_of(double value, const std::vector<double>& edges) {
  if (!(value >= edges.front() && value < edges.back())) return -1;
  return std::ranges::upper_bound(edges, value) - edges.begin() - 1;
}

AngleVelocityMap map_of(const MeasuredMotion& motion, const GapSeries& series) {
  AngleVelocityMap map;
  map.angle_edges_rad = even_edges(motion.angle_rad, kMapBins);
  map.rate_edges_rad_s = even_edges(motion.rate_rad_s, kMapBins);
  const std::size_t cells = kMapBins * kMapBins;
  std::vector<double> before(cells, 0.0);
  std::vector<double> after(cells, 0.0);
  std::vector<int> samples(cells, 0);
  for (std::size_t i = 0; i < motion.angle_rad.size(); ++i) {
    const std::ptrdiff_t column = bin_of(motion.angle_rad[i], map.angle_edges_rad);
    const std::ptrdiff_t row = bin_of(motion.rate_rad_s[i], map.rate_edges_rad_s);
    if (column < 0 || row < 0 || !std::isfinite(series.torque_residual_nm[i])) continue;
    const std::size_t cell = static_cast<std::size_t>(row) * kMapBins + static_cast<std::size_t>(column);
    before[cell] += series.torque_residual_nm[i];
    after[cell] += series.torque_residual_after_nm[i];
    samples[cell] += 1;
  }
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const bool seen = samples[cell] >= 5;
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    map.mean_torque_nm.push_back(seen ? before[cell] / samples[cell] : nothing);
    map.mean_torque_after_nm.push_back(seen ? after[cell] / samples[cell] : nothing);
  }
  return map;
}

double held_out_rms(const std::vector<double>& x, const std::vector<char>& held_out) {
  double squares = 0;
  double count = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (held_out[i] == 0 || !std::isfinite(x[i])) continue;
    squares += x[i] * x[i];
    count += 1;
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

std::string place_words(const GapAxis& axis, const GapPlace& place) {
  if (axis.axis == "frequency") return fmt::format("lies between {:.3g} and {:.3g} Hz", place.low, place.high);
  if (axis.axis == "time") {
    const double zero_s = reading_zero_s(axis.bins.front().low);
    return fmt::format("arises between {:.1f} and {:.1f} s", place.low - zero_s, place.high - zero_s);
  }
  if (axis.axis == "velocity") return fmt::format("arises at {:.3g} to {:.3g} rad/s", place.low, place.high);
  if (axis.axis == "position") {
    return fmt::format("arises at wheel angles of {:.3g} to {:.3g} rad", place.low, place.high);
  }
  if (axis.axis == "amplitude") {
    return fmt::format("arises while the wheel swings by {:.3g} to {:.3g} rad", place.low, place.high);
  }
  return fmt::format("follows the {}", axis.bin_names[static_cast<std::size_t>(place.low)]);
}

/// `expected_share`: of the noise there. An interval that reaches down to it says that the gap may be anywhere.
std::string sentence(const GapAxis& axis, const GapPlace& place, double expected_share) {
  const BoundedValue& share = place.share_of_gap;
  const std::string range =
      fmt::format("{:.0f} % ({:.0f} to {:.0f} %)", 100 * share.value, 100 * share.low, 100 * share.high);
  const std::string words = place_words(axis, place);
  if (share.low > expected_share) return fmt::format("{} of the gap {}.", range, words);
  return fmt::format("The record does not tell where the gap is; most of it, {}, {}.", range, words);
}

/// The narrowest run of neighbouring bins that holds half of the gap.
GapPlace place_on(const GapAxis& axis) {
  GapPlace place;
  place.axis = axis.axis;
  place.unit = axis.unit;
  double expected_share = 0;
  const std::size_t n = axis.bins.size();
  for (std::size_t width = 1; width <= n; ++width) {
    std::size_t best = 0;
    double most = -1;
    for (std::size_t from = 0; from + width <= n; ++from) {
      double sum = 0;
      for (std::size_t i = from; i < from + width; ++i) sum += axis.bins[i].share.value;
      if (sum > most) {
        most = sum;
        best = from;
      }
    }
    if (most < 0.5 && width < n) continue;
    place.low = axis.bins[best].low;
    place.high = axis.bins[best + width - 1].high;
    for (std::size_t i = best; i < best + width; ++i) {
      place.share_of_gap.value += axis.bins[i].share.value;
      place.share_of_gap.low += axis.bins[i].share.low;
      place.share_of_gap.high += axis.bins[i].share.high;
      expected_share += axis.bins[i].expected_share;
    }
    place.share_of_gap.high = std::min(place.share_of_gap.high, 1.0);
    break;
  }
  place.says = sentence(axis, place, expected_share);
  return place;
}

}  // namespace

void localise(Diagnosis& diagnosis, const PreparedRecord& prepared, const NoiseFloor& floor) {
  const Record& record = prepared.record;
  GapSeries& series = diagnosis.series;
  const WheelArm& wheel = diagnosis.refit.wheel;
  series.torque_residual_nm = residual_torque(record, prepared.stretches, series.refit_rad, wheel);
  series.torque_residual_after_nm =
      residual_torque(record, prepared.stretches, series.with_effect_rad, diagnosis.with_effect.wheel);
  const double applied = prepared.spectral->applied_rms_nm;
  diagnosis.gap.torque_refit = held_out_rms(series.torque_residual_nm, series.held_out) / applied;
  diagnosis.gap.torque_with_effect = held_out_rms(series.torque_residual_after_nm, series.held_out) / applied;
  const double noise = residual_torque_noise(floor, wheel);
  diagnosis.gap.torque_floor = std::sqrt(noise) / applied;
  const MeasuredMotion& motion = prepared.spectral->motion;
  diagnosis.map = map_of(motion, series);
  diagnosis.spectrum = residual_spectrum(record, prepared.stretches, series, floor, diagnosis.with_effect.wheel);
  if (!diagnosis.unexplained.complete) diagnosis.unexplained.where = band_of_rest(diagnosis.spectrum);
  diagnosis.axes = gap_axes(record, motion, series, diagnosis.spectrum, noise);
  // Beside a driver's steering nobody knows where the wheel is.
  const auto tells_by_place = [](const GapAxis& axis) {
    return axis.axis == "velocity" || axis.axis == "position" || axis.axis == "amplitude" || axis.axis == "reversal";
  };
  if (prepared.lowest_hz > 0) std::erase_if(diagnosis.axes, tells_by_place);
  const auto chosen = std::ranges::find_if(diagnosis.axes, [](const GapAxis& axis) { return axis.axis != "reversal"; });
  if (chosen != diagnosis.axes.end()) diagnosis.where = place_on(*chosen);
  if (diagnosis.verdict == "none") diagnosis.where.says = "There is no gap to place: what is left is noise.";
}

}  // namespace steerid::gap
