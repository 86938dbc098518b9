// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/slipped_messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "log/channel_noise.hpp"

namespace steerid {
namespace {

constexpr std::size_t kOrder = 24;
constexpr std::size_t kMostMissing = 3;

/// What messages in a row are worth that an autoregression of the channel predicts, some of which may be missing.
class Course {
 public:
  explicit Course(const std::vector<double>& messages) : messages_(messages) {
    mean_ = std::reduce(messages.begin(), messages.end()) / static_cast<double>(messages.size());
    std::array<double, kOrder + 1> covariance{};
    for (std::size_t lag = 0; lag <= kOrder; ++lag) {
      for (std::size_t i = lag; i < messages.size(); ++i) covariance[lag] += at(i) * at(i - lag);
    }
    predict_by(covariance);
    std::vector<double> squares;
    for (std::size_t i = kOrder; i < messages.size(); ++i) {
      double error = 0;
      for (std::size_t k = 0; k <= kOrder; ++k) error += weight_[k] * at(i - k);
      squares.push_back(error * error);
    }
    constexpr double kMedianOfChiSquare = 0.455;
    const auto middle = squares.begin() + std::ssize(squares) / 2;
    std::ranges::nth_element(squares, middle);
    variance_ = *middle / kMedianOfChiSquare;
  }
  [[nodiscard]] double variance() const { return variance_; }

  /// Half of the squared prediction errors of the messages behind a place, in deviations.
  struct Errors {
    double nats;  ///< of all of them
    double
        but_a_blow;  ///< without the largest two neighbours: as it is where the wheel's rate changes between two rows
  };

  /// Of the messages from m on, where so many are missing before it, which read as what fits best; or where so many
  /// `read_as_before` are messages as any other.
  [[nodiscard]] Errors errors(std::size_t m, std::size_t missing, bool read_as_before = false) const {
    const std::size_t count = kOrder + missing;
    std::vector<double> error(count, 0.0);
    std::vector<std::array<double, kMostMissing>> by_missing(count);
    for (std::size_t row = 0; row < count; ++row) {
      by_missing[row].fill(0);
      for (std::size_t k = 0; k <= kOrder; ++k) {
        const auto place = static_cast<std::ptrdiff_t>(row) - static_cast<std::ptrdiff_t>(k);  // 0: behind the last one
        const auto gap = static_cast<std::ptrdiff_t>(missing);
        if (place >= 0 && place < gap) {
          if (read_as_before) {
            error[row] += weight_[k] * at(m - 1);
          } else {
            by_missing[row][static_cast<std::size_t>(place)] += weight_[k];
          }
        } else {
          const std::ptrdiff_t index = static_cast<std::ptrdiff_t>(m) + (place < 0 ? place : place - gap);
          error[row] += weight_[k] * at(static_cast<std::size_t>(index));
        }
      }
    }
    // One after the other, each orthogonal to those before it.
    for (std::size_t u = 0; u < missing && !read_as_before; ++u) {
      const auto dot = [&](std::size_t a, std::size_t b) {
        double sum = 0;
        for (const auto& row : by_missing) sum += row[a] * row[b];
        return sum;
      };
      for (std::size_t before = 0; before < u; ++before) {
        const double share = dot(u, before) / dot(before, before);
        for (auto& row : by_missing) row[u] -= share * row[before];
      }
      double along = 0;
      for (std::size_t row = 0; row < count; ++row) along += by_missing[row][u] * error[row];
      const double share = along / dot(u, u);
      for (std::size_t row = 0; row < count; ++row) error[row] -= share * by_missing[row][u];
    }
    double squares = 0;
    double largest = 0;
    for (std::size_t row = 0; row < count; ++row) {
      squares += error[row] * error[row];
      if (row > 0) largest = std::max(largest, error[row - 1] * error[row - 1] + error[row] * error[row]);
    }
    return {squares / (2 * variance_), (squares - largest) / (2 * variance_)};
  }

 private:
  [[nodiscard]] double at(std::size_t i) const { return messages_[i] - mean_; }

  /// The weights of the prediction error, the present one's first: Levinson and Durbin's recursion.
  void predict_by(std::array<double, kOrder + 1> covariance) {
    constexpr double kRounding = 1e-12;
    covariance[0] *= 1 + kRounding;
    weight_[0] = 1;
    double left = covariance[0];
    for (std::size_t order = 1; order <= kOrder && left > 0; ++order) {
      double sum = 0;
      for (std::size_t k = 0; k < order; ++k) sum += weight_[k] * covariance[order - k];
      const double reflection = -sum / left;
      const std::array<double, kOrder + 1> before = weight_;
      for (std::size_t k = 1; k <= order; ++k) weight_[k] = before[k] + reflection * before[order - k];
      left *= 1 - reflection * reflection;
    }
  }

  const std::vector<double>& messages_;
  double mean_ = 0;
  std::array<double, kOrder + 1> weight_{};
  double variance_ = 0;
};

double median(const std::vector<Course::Errors>& errors) {
  std::vector<double> nats;
  for (const Course::Errors& one : errors) nats.push_back(one.nats);
  if (nats.empty()) return 0;
  const auto middle = nats.begin() + std::ssize(nats) / 2;
  std::ranges::nth_element(nats, middle);
  return *middle;
}

/// Places at which more than `most` is left, a run of kOrder messages being one.
std::size_t surprises(const std::vector<Course::Errors>& errors, double most) {
  std::size_t count = 0;
  std::size_t free_from = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!(errors[i].nats > most)) continue;
    if (i >= free_from) ++count;
    free_from = i + kOrder;
  }
  return count;
}

}  // namespace

std::optional<MessageNumbers> slipped_numbers(std::span<const double> values, bool inert) {
  constexpr std::size_t kFewest = 200;  // rows
  constexpr double kSteps = 10;         // of noise, as in log/late_messages.cpp
  constexpr double kRepeatsARow = 1e-3;
  constexpr double kSlipsARow = 3e-4;   // three times what crystals of 100 ppm make
  constexpr double kSure_nats = 7;      // a thousand to one
  constexpr double kLikelier_nats = 5;  // 150 to one
  constexpr double kUsual = 3;          // times the median; white errors have 1.8 times it in one of 100 places
  if (values.size() < kFewest) return std::nullopt;
  MessageNumbers out;
  std::vector<double> messages;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0 && values[i] == values[i - 1]) continue;
    out.row.push_back(i);
    messages.push_back(values[i]);
  }
  const auto rows = static_cast<double>(values.size());
  const auto all_repeats = static_cast<double>(values.size() - messages.size());
  if (all_repeats > std::max(3.0, kRepeatsARow * rows)) return std::nullopt;
  const Course course(messages);
  if (!(std::sqrt(course.variance()) > kSteps * smallest_step(values))) return std::nullopt;
  std::vector<Course::Errors> with_none;  // of every message that has enough of them on either side
  for (std::size_t m = kOrder + 1; m + kOrder <= messages.size(); ++m) with_none.push_back(course.errors(m, 0));
  const double usual = kUsual * median(with_none);
  std::ptrdiff_t slipped = 0;
  bool any_skipped = false;
  bool any_repeated = false;
  for (std::size_t m = 0; m < messages.size(); ++m) {
    if (m > kOrder && m + kOrder <= messages.size()) {
      const Course::Errors& none = with_none[m - kOrder - 1];
      const std::size_t repeats = out.row[m] - out.row[m - 1] - 1;
      const std::size_t places = std::clamp<std::size_t>(repeats, 1, kMostMissing);
      const bool may_have = repeats > 0 || (inert && none.but_a_blow > kSure_nats + std::log(rows));
      double missing = may_have ? course.errors(m, places).nats : 0;
      if (repeats > 0) missing = std::min(missing, course.errors(m, places, true).nats);
      const bool skipped =
          may_have && repeats == 0 && missing < usual && none.but_a_blow - missing > kSure_nats + std::log(rows);
      const bool repeated = repeats > 0 && missing - none.nats > kLikelier_nats + std::log(all_repeats);
      if (skipped) ++slipped;
      if (repeated) slipped -= static_cast<std::ptrdiff_t>(repeats);
      if (skipped || repeated) out.slips.push_back(out.row[m]);
      any_skipped = any_skipped || skipped;
      any_repeated = any_repeated || repeated;
    }
    out.number.push_back(static_cast<std::ptrdiff_t>(out.row[m]) + slipped);
  }
  if (any_skipped == any_repeated) return std::nullopt;  // one clock is the faster one
  if (any_skipped && surprises(with_none, usual + kSure_nats + std::log(rows)) > out.slips.size()) return std::nullopt;
  if (static_cast<double>(out.slips.size()) > 1 + kSlipsARow * rows) return std::nullopt;
  if (any_skipped) {  // what comes behind the first is of its own row
    for (std::ptrdiff_t& number : out.number) --number;
  }
  return out;
}

}  // namespace steerid
