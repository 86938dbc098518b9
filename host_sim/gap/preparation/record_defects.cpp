// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/preparation/record_defects.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "gap/likelihood/block_spectra.hpp"
#include "gap/likelihood/noise_floor.hpp"
#include "gap/preparation/lost_samples.hpp"
#include "log/quantile.hpp"
#include "log/resample.hpp"
#include "plant/effects/vocabulary.hpp"
#include "plant/hidden_samples.hpp"

namespace steerid::gap {
namespace {

/// The step of a signal's resolution: the smallest distance between distinct values that the others are multiples of;
/// 0 when there is none above a millionth of the range.
double lattice_step(const std::vector<double>& signal) {
  std::vector<double> values = signal;
  std::ranges::sort(values);
  const double range = values.back() - values.front();
  if (!(range > 0)) return 0;
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double gap = values[i] - values[i - 1];
    if (gap > 1e-6 * range) step = std::min(step, gap);
  }
  // Written with few digits, a lattice wobbles by the last of them: take the mean step of neighbours.
  double sum = 0;
  double count = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double gap = values[i] - values[i - 1];
    const double multiples = std::round(gap / step);
    if (multiples < 1 || multiples > 3) continue;
    if (std::abs(gap / multiples - step) > 0.1 * step) return 0;
    sum += gap / multiples;
    count += 1;
  }
  return count > 0 ? sum / count : 0;
}

/// A smooth stand-in for the angle's motion: the centred mean over a few samples.
std::vector<double> local_mean(const std::vector<double>& x, std::ptrdiff_t reach) {
  const auto n = static_cast<std::ptrdiff_t>(x.size());
  std::vector<double> out(x.size());
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    double sum = 0;
    double count = 0;
    for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(0, i - reach); k <= std::min(n - 1, i + reach); ++k) {
      sum += x[static_cast<std::size_t>(k)];
      count += 1;
    }
    out[static_cast<std::size_t>(i)] = sum / count;
  }
  return out;
}

void look_for_coarse_quantization(const Record& record, double step, double angle_variance, RecordDefects& out) {
  // White noise of a rounded angle has step^2/12 from the rounding alone; 0.5 mrad beside 0.3 mrad of noise makes 0.2.
  const double share = step * step / 12 / angle_variance;
  const double distinct = (*std::ranges::max_element(record.angle_rad) - *std::ranges::min_element(record.angle_rad)) /
                          std::max(step, 1e-12);
  constexpr double kShare = 0.5;
  if (step <= 0 || share < kShare || distinct > 5000) return;
  Effect effect(effect::coarse_quantization);
  effect.at("step_rad") = step;
  out.found.push_back({effect, share / kShare - 1});
}

/// Noise of one sample against its neighbours, rad: the median is that of samples which did not repeat.
double noise_of_a_sample(const std::vector<double>& angle) {
  std::vector<double> second;
  for (std::size_t i = 2; i < angle.size(); ++i) {
    second.push_back(std::abs(angle[i] - 2 * angle[i - 1] + angle[i - 2]));
  }
  return median(std::move(second)) / (kMedianOfNormal * std::sqrt(6.0));
}

/// 1 where a sample repeats the one before exactly.
std::vector<char> repeats(const std::vector<double>& angle) {
  std::vector<char> out(angle.size(), 0);
  for (std::size_t i = 1; i < angle.size(); ++i) out[i] = angle[i] == angle[i - 1] ? 1 : 0;
  return out;
}

constexpr double kLostShare = 0.012;

constexpr double kPlainlyLost = 0.06;  // where the wheel hardly moves

constexpr std::size_t kFewest = 3;  // samples, in a row or in all, or runs of them: fewer are chance

/// The share of samples that are lost, by the repeats where the wheel moves: a sample is expected to move by more than
/// four times its noise and its resolution. A sample is lost whether the wheel moves fast or slowly: the faster half of
/// them says how many are. Backlash of the sensor repeats only after a reversal, and a resolution where the wheel is
/// slow. 0: no more than chance makes.
double lost_share(const std::vector<double>& angle, const std::vector<char>& repeated, double noise, double step) {
  const std::vector<double> mean = local_mean(angle, 3);
  struct Moving {
    double expected;
    char repeats;
  };
  std::vector<Moving> moving;
  for (std::size_t i = 4; i + 4 < angle.size(); ++i) {
    const double expected = std::abs(mean[i + 3] - mean[i - 3]) / 6;
    if (expected >= 4 * std::max(noise, step)) moving.push_back({expected, repeated[i]});
  }
  if (moving.size() < 30) {
    // A wheel that hardly moves: what exceeds the repeats that noise and resolution make among neighbours.
    const double chance =
        step > 0 ? std::erf(step / (2 * std::numbers::sqrt2 * std::numbers::sqrt2 * std::max(noise, 0.3 * step))) : 0;
    const double all =
        static_cast<double>(std::ranges::count(repeated, char{1})) / static_cast<double>(repeated.size());
    const double loss = chance < 0.9 ? (all - chance) / (1 - chance) : 0;
    return loss < kPlainlyLost ? 0 : loss;
  }
  const auto half = moving.begin() + std::ssize(moving) / 2;
  std::ranges::nth_element(moving, half, std::greater<>(), &Moving::expected);
  const auto count =
      static_cast<double>(std::count_if(moving.begin(), half, [](const Moving& one) { return one.repeats != 0; }));
  // By chance it repeats when noise undoes four of its own sizes to within a step: below half a percent.
  const double share = count / static_cast<double>(half - moving.begin());
  return share < kLostShare || count < static_cast<double>(kFewest) ? 0 : share;
}

/// The share of samples in runs of repeats that end with a jump, by far more than the `finest` motion that shows.
/// Neither a wheel that rests nor backlash of the sensor jumps: both go on from where they are as fast as they move
/// then.
double lost_in_runs(const std::vector<double>& angle, const std::vector<char>& repeated, double finest) {
  constexpr double kPlainly = 6;
  constexpr double kFaster = 2;  // than the motion that follows
  std::size_t runs = 0;
  std::size_t lost = 0;
  std::size_t length = 0;
  for (std::size_t i = 1; i + 1 < angle.size(); ++i) {
    if (repeated[i] != 0) {
      ++length;
      continue;
    }
    const double jump = std::abs(angle[i] - angle[i - 1]);
    if (length >= kFewest && jump > kPlainly * finest && jump > kFaster * std::abs(angle[i + 1] - angle[i])) {
      ++runs;
      lost += length;
    }
    length = 0;
  }
  return runs < kFewest ? 0 : static_cast<double>(lost) / static_cast<double>(angle.size());
}

void look_for_sample_loss(const Record& record, double step, RecordDefects& out) {
  std::vector<char> repeated = repeats(record.angle_rad);
  const double noise = noise_of_a_sample(record.angle_rad);
  const double in_runs = lost_in_runs(record.angle_rad, repeated, std::max(noise, step));
  const double loss = std::max(lost_share(record.angle_rad, repeated, noise, step), in_runs);
  if (!(loss > 0)) return;
  Effect effect(effect::sample_loss);
  effect.at("loss_probability") = std::clamp(loss, 0.001, 0.9);
  out.found.push_back({effect, std::max(loss / kLostShare - 1, in_runs > 0 ? 1.0 : 0.0)});
  out.lost = std::move(repeated);
  out.repaired.angle_rad = over_lost_samples(record.angle_rad, out.lost);
}

/// Samples that crowd at the largest size that a channel ever has.
struct Crowd {
  double plainness = 0;  ///< how many times what the strip of the same width below it holds
  double level_nm = 0;
};

constexpr std::ptrdiff_t kFewestCrowded = 15;

/// The plainest crowd within `width` of one size with nothing beyond it. The round top of a peak crowds too, but no
/// more than 2.4 times what the strip of the same width below it holds (a parabola spends sqrt(2) - 1 as long there).
Crowd crowd_at_the_top(const std::vector<double>& sizes, double width) {
  const double most = sizes.back();
  const auto held = [&](double low, double high) {
    return static_cast<double>(std::ranges::upper_bound(sizes, high) - std::ranges::lower_bound(sizes, low));
  };
  Crowd best;
  for (double top = most; top > most - 2 * width; top -= width / 10) {
    const double crowd = held(top - width, top);
    const double below = std::max(3.0, held(top - 2.5 * width, top - 1.5 * width));
    const auto beyond = static_cast<double>(sizes.end() - std::ranges::upper_bound(sizes, top));
    if (beyond > 0.05 * crowd || crowd < kFewestCrowded || crowd / below <= best.plainness) continue;
    const auto crowded = std::ranges::lower_bound(sizes, top - width);
    best = {crowd / below, crowded[(sizes.end() - crowded) / 2]};
  }
  return best;
}

/// Noise of a sample that lies below `most`, by tenth differences, which a torque below 10 Hz leaves at 3e-5 of itself;
/// their median, so that jumps and corners do not count.
double noise_below(const std::vector<double>& signal, double most) {
  constexpr std::size_t kOrder = 10;
  constexpr double kGain = 429.8;  // of white noise: the root of 20!/(10!)^2
  std::vector<double> difference = signal;
  for (std::size_t order = 0; order < kOrder; ++order) {
    for (std::size_t i = 0; i + 1 < difference.size(); ++i) difference[i] = difference[i + 1] - difference[i];
    if (!difference.empty()) difference.pop_back();
  }
  std::vector<double> sizes;
  std::size_t below = 0;  // samples in a row
  for (std::size_t i = 0; i < signal.size(); ++i) {
    below = std::abs(signal[i]) < most ? below + 1 : 0;
    if (below > kOrder) sizes.push_back(std::abs(difference[i - kOrder]));
  }
  if (sizes.empty()) return 0;
  return median(std::move(sizes)) / (kMedianOfNormal * kGain);
}

struct Clipping {
  double strength = 0;  ///< above 0 where the channel is clipped
  double level_nm = 0;
  bool certain = false;  ///< not made by a torque that is flat on purpose
};

/// Whether and where a channel is clipped. Clipped samples crowd within the noise that was added behind the limit,
/// which is no more than the channel's own: where a loop answers the angle's noise that is clipped with the rest, and
/// the channel's noise is many times what a clipped sample has. A channel with noise that has its largest size exactly,
/// again and again, is clipped for certain: noise alone never does, and a flat top that was asked for has it on top.
Clipping clipping_of(const std::vector<double>& torque, double noise_nm) {
  constexpr double kCrowded = 5;
  constexpr double kNarrowest = 1e-3;   // of the largest size; less noise is none
  constexpr double kOvershoot = 0.015;  // likewise: a filter behind the limit rounds what is clipped, and overshoots
  constexpr double kWidest = 0.2;       // or there is no top, as on a channel on which little happens
  constexpr double kSteps = 3;          // of the resolution: on fewer samples crowd anyway
  constexpr double kNoisySteps = 10;    // likewise: noise of fewer repeats by itself
  std::vector<double> sizes;
  for (const double value : torque) sizes.push_back(std::abs(value));
  std::ranges::sort(sizes);
  const double most = sizes.back();
  const double step = lattice_step(torque);
  const double narrowest = std::max(kNarrowest * most, kSteps * step);
  Crowd best;
  for (double width = std::max({5 * noise_nm, narrowest, kOvershoot * most}); width >= narrowest && width > 0;
       width /= 2) {
    if (width > kWidest * most) continue;
    const Crowd crowd = crowd_at_the_top(sizes, width);
    if (crowd.plainness > best.plainness) best = crowd;
  }
  Clipping found{best.plainness / kCrowded - 1, best.level_nm};
  const auto at_most = sizes.end() - std::ranges::lower_bound(sizes, most);
  found.certain = found.strength > 0 && at_most >= kFewestCrowded &&
                  noise_below(torque, most) > std::max(kNarrowest * most, kNoisySteps * step);
  return found;
}

/// The repair, and what it leaves open. An autoregression that was fitted to filled samples thinks too well of itself.
void fill_clipped(std::vector<double>& torque, double limit_nm, double noise_variance,
                  std::vector<HiddenTorque>& hidden) {
  constexpr double kDoubt = 4;  // deviations
  const HiddenSamples filled(torque, clipped_stretches(torque, limit_nm), limit_nm);
  for (const HiddenStretch& stretch : filled.stretches()) {
    Eigen::MatrixXd shapes =
        filled.uncertain(stretch, noise_variance / (kDoubt * kDoubt), kHighest_hz / kResampledRateHz);
    if (shapes.cols() > 0) hidden.push_back({stretch.first, kDoubt * shapes});
  }
}

void look_for_saturation(const Record& record, RecordDefects& out) {
  Clipping plainest;
  for (const std::vector<double>* channel : {&record.torque_driver_nm, &record.torque_motor_nm}) {
    const Clipping found = clipping_of(*channel, std::sqrt(white_noise_variance(*channel, record)));
    if (found.strength > plainest.strength) plainest = found;
  }
  if (!(plainest.strength > 0)) return;
  Effect effect(effect::torque_saturation);
  effect.at("limit_nm") = std::clamp(plainest.level_nm, 0.05, 100.0);
  out.found.push_back({effect, plainest.strength, plainest.certain});
  double noise_variance = 0;
  for (const std::vector<double>* channel : {&record.torque_driver_nm, &record.torque_motor_nm}) {
    noise_variance += white_noise_variance(*channel, record);
  }
  for (std::vector<double>* channel : {&out.repaired.torque_driver_nm, &out.repaired.torque_motor_nm}) {
    fill_clipped(*channel, effect.values[0], noise_variance, out.hidden);
  }
}

}  // namespace

double RecordDefect::probability() const {
  constexpr double kMost = 0.99;
  constexpr double kInDoubt = 0.35;  // of being wrong at the threshold of doubt
  constexpr double kDecline = 2.5;   // per unit of strength
  return kMost - kInDoubt * std::exp(-kDecline * std::max(0.0, strength));
}

RecordDefects record_defects(const Record& record) {
  RecordDefects out;
  out.repaired = record;
  if (record.size() < 200) return out;
  const double step = lattice_step(record.angle_rad);
  look_for_coarse_quantization(record, step, white_noise_variance(record.angle_rad, record), out);
  if (out.found.empty()) look_for_sample_loss(record, step, out);  // a coarse angle repeats by itself
  look_for_saturation(record, out);
  return out;
}

}  // namespace steerid::gap
