// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/slipped_messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "log/channel_noise.hpp"
#include "log/linear_prediction.hpp"
#include "log/new_values.hpp"
#include "log/quantile.hpp"

namespace steerid {
namespace {

constexpr std::size_t kOrder = 24;
constexpr std::size_t kMostMissing = 3;

/// How well an autoregression of the channel predicts the kOrder messages behind a place, some of which may be missing:
/// half of their squared errors, in deviations.
class Course {
 public:
  explicit Course(const std::vector<double>& messages) : centred_(messages) {
    const double mean = std::reduce(messages.begin(), messages.end()) / static_cast<double>(messages.size());
    for (double& one : centred_) one -= mean;
    std::array<double, kOrder + 1> covariance{};
    for (std::size_t lag = 0; lag <= kOrder; ++lag) {
      for (std::size_t i = lag; i < centred_.size(); ++i) covariance[lag] += centred_[i] * centred_[i - lag];
    }
    constexpr double kRounding = 1e-12;
    covariance[0] *= 1 + kRounding;
    weight_ = linear_prediction(covariance).weight;
    error_ = errors_of(centred_);
    std::vector<double> squares;
    for (const double one : error_) squares.push_back(one * one);
    variance_ = median(std::move(squares)) / (kMedianOfNormal * kMedianOfNormal);
  }
  [[nodiscard]] double variance() const { return variance_; }

  struct Left {
    double nats;        ///< of all of them
    double but_a_blow;  ///< but the largest two in a row: as it is where the wheel's rate changes between two rows
  };

  /// Of the messages from m on, as they came.
  [[nodiscard]] Left left(std::size_t m) const {
    const double* const error = &error_[m - kOrder];
    double squares = 0;
    double largest = 0;
    for (std::size_t i = 0; i < kOrder; ++i) {
      squares += error[i] * error[i];
      if (i > 0) largest = std::max(largest, error[i - 1] * error[i - 1] + error[i] * error[i]);
    }
    return {squares / (2 * variance_), (squares - largest) / (2 * variance_)};
  }

  /// The same where `count` more read as the one before them.
  [[nodiscard]] double left_with_repeats(std::size_t m, std::size_t count) const {
    return nats(errors_of(around(m, count, centred_[m - 1])));
  }

  /// The same where `count` are missing before them, which read as what fits best.
  [[nodiscard]] double left_with_missing(std::size_t m, std::size_t count) const {
    std::vector<double> error = errors_of(around(m, count, 0));
    std::vector<std::vector<double>> by_missing;  // the errors that each makes, orthogonal to those before it
    const auto dot = [](const std::vector<double>& a, const std::vector<double>& b) {
      return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
    };
    const auto take_off = [&](std::vector<double>& from, const std::vector<double>& one) {
      const double share = dot(one, from) / dot(one, one);
      for (std::size_t i = 0; i < from.size(); ++i) from[i] -= share * one[i];
    };
    for (std::size_t u = 0; u < count; ++u) {
      std::vector<double> one(error.size(), 0.0);
      std::ranges::copy(weight_, one.begin() + static_cast<std::ptrdiff_t>(u));
      for (const std::vector<double>& before : by_missing) take_off(one, before);
      take_off(error, one);
      by_missing.push_back(std::move(one));
    }
    return nats(error);
  }

 private:
  /// Of all that have kOrder before them.
  [[nodiscard]] std::vector<double> errors_of(const std::vector<double>& series) const {
    std::vector<double> error;
    for (std::size_t i = kOrder; i < series.size(); ++i) {
      double sum = 0;
      for (std::size_t k = 0; k <= kOrder; ++k) sum += weight_[k] * series[i - k];
      error.push_back(sum);
    }
    return error;
  }

  /// kOrder messages on either side of `count` that read `value`.
  [[nodiscard]] std::vector<double> around(std::size_t m, std::size_t count, double value) const {
    const auto middle = centred_.begin() + static_cast<std::ptrdiff_t>(m);
    std::vector<double> series(middle - kOrder, middle);
    series.insert(series.end(), count, value);
    series.insert(series.end(), middle, middle + kOrder);
    return series;
  }

  [[nodiscard]] double nats(const std::vector<double>& error) const {
    return std::inner_product(error.begin(), error.end(), error.begin(), 0.0) / (2 * variance_);
  }

  std::vector<double> centred_;
  std::array<double, kOrder + 1> weight_{};
  std::vector<double> error_;  // from message kOrder on
  double variance_ = 0;
};

/// Places at which more than `most` is left, a run of kOrder messages being one.
std::size_t surprises(const std::vector<double>& nats, double most) {
  std::size_t count = 0;
  std::size_t free_from = 0;
  for (std::size_t i = 0; i < nats.size(); ++i) {
    if (!(nats[i] > most)) continue;
    if (i >= free_from) ++count;
    free_from = i + kOrder;
  }
  return count;
}

}  // namespace

std::optional<MessageNumbers> slipped_numbers(std::span<const double> values, bool inert) {
  constexpr std::size_t kFewest = 200;  // rows
  constexpr double kRepeatsARow = 1e-3;
  constexpr double kSlipsARow = 3e-4;   // three times what crystals of 100 ppm make
  constexpr double kSure_nats = 7;      // a thousand to one
  constexpr double kLikelier_nats = 5;  // 150 to one
  constexpr double kUsual = 3;          // times the median; white errors have 1.8 times it in one of 100 places
  if (values.size() < kFewest) return std::nullopt;
  NewValues found = new_values(values);
  const auto rows = static_cast<double>(values.size());
  const auto all_repeats = static_cast<double>(values.size() - found.row.size());
  if (all_repeats > std::max(3.0, kRepeatsARow * rows) || found.row.size() <= 2 * kOrder) return std::nullopt;
  const Course course(found.value);
  if (!repeats_tell(std::sqrt(course.variance()), values)) return std::nullopt;
  const double anywhere_nats = kSure_nats + std::log(rows);
  const std::size_t first = kOrder + 1;
  const std::size_t end = found.row.size() - kOrder + 1;
  std::vector<double> as_they_came;
  for (std::size_t m = first; inert && m < end; ++m) as_they_came.push_back(course.left(m).nats);
  const double usual = inert ? kUsual * median(as_they_came) : 0;
  MessageNumbers out{.row = std::move(found.row)};
  std::ptrdiff_t slipped = 0;
  bool any_skipped = false;
  bool any_repeated = false;
  for (std::size_t m = 0; m < out.row.size(); ++m) {
    if (m >= first && m < end) {
      const Course::Left left = course.left(m);
      const std::size_t repeats = out.row[m] - out.row[m - 1] - 1;
      const auto repeated = [&] {
        const std::size_t count = std::min(repeats, kMostMissing);
        const double otherwise = std::min(course.left_with_missing(m, count), course.left_with_repeats(m, count));
        return otherwise - left.nats > kLikelier_nats + std::log(all_repeats);
      };
      const auto skipped = [&] {
        if (!inert || !(left.but_a_blow > anywhere_nats)) return false;
        const double missing = course.left_with_missing(m, 1);
        return missing < usual && left.but_a_blow - missing > anywhere_nats;
      };
      if (repeats > 0 ? repeated() : skipped()) {
        slipped += repeats > 0 ? -static_cast<std::ptrdiff_t>(repeats) : 1;
        (repeats > 0 ? any_repeated : any_skipped) = true;
        out.slips.push_back(out.row[m]);
      }
    }
    out.number.push_back(static_cast<std::ptrdiff_t>(out.row[m]) + slipped);
  }
  if (any_skipped == any_repeated) return std::nullopt;  // one clock is the faster one
  if (any_skipped && surprises(as_they_came, usual + anywhere_nats) > out.slips.size()) return std::nullopt;
  if (static_cast<double>(out.slips.size()) > 1 + kSlipsARow * rows) return std::nullopt;
  if (any_skipped) {  // what comes behind the first is of its own row
    for (std::ptrdiff_t& number : out.number) --number;
  }
  return out;
}

}  // namespace steerid
