// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/late_messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "log/bend.hpp"
#include "log/channel_noise.hpp"
#include "log/new_values.hpp"
#include "log/quantile.hpp"

namespace steerid {
namespace {

constexpr int kMostLate = 2;   // rows
constexpr int kMostAhead = 3;  // numbers from one new value to the next
constexpr int kLates = kMostLate + 1;
constexpr int kStates = kLates * kMostAhead * kMostAhead;
constexpr double kSlip_nats = 10;  // crystals of 100 ppm at 100 Hz slip once in 10,000 rows
constexpr double kImpossible = -std::numeric_limits<double>::infinity();

/// How late a value is, and how many numbers it and the one before it are ahead of those before them.
struct State {
  int late;
  int before;
  int ahead;
  [[nodiscard]] int index() const { return (late * kMostAhead + before - 1) * kMostAhead + ahead - 1; }
  static State of(int index) {
    return {index / (kMostAhead * kMostAhead), index / kMostAhead % kMostAhead + 1, index % kMostAhead + 1};
  }
};

using Nats = std::array<double, kStates>;  // of every state

/// A channel's new values, and the walks of their messages' numbers.
class Walks {
 public:
  explicit Walks(NewValues values) : row_(std::move(values.row)), value_(std::move(values.value)) {
    for (int a = 1; a <= kMostAhead; ++a) {
      for (int b = 1; b <= kMostAhead; ++b) {
        for (int c = 1; c <= kMostAhead; ++c) {
          bends_[bend_index(a, b, c)] = bend_weights({0.0, 1.0 * a, 1.0 * (a + b), 1.0 * (a + b + c)});
        }
      }
    }
  }

  [[nodiscard]] const std::vector<std::size_t>& rows() const { return row_; }
  [[nodiscard]] std::size_t repeats() const { return row_.back() + 1 - row_.size(); }

  /// By the median of the bends along a walk, or with no message left out.
  void take_variance(const std::vector<std::ptrdiff_t>& number = {}) {
    std::vector<double> squares;
    for (std::size_t m = 3; m < value_.size(); ++m) {
      const auto ahead = [&](std::size_t i) {
        return number.empty() ? 1 : static_cast<int>(number[i] - number[i - 1]);
      };
      squares.push_back(std::pow(bend(m, ahead(m - 2), ahead(m - 1), ahead(m)), 2));
    }
    variance_ = median(std::move(squares)) / (kMedianOfNormal * kMedianOfNormal);
  }
  [[nodiscard]] double variance() const { return variance_; }

  /// Log likelihood of the first `count` values over all walks.
  [[nodiscard]] double nats(double in_time_again, std::size_t count) const {
    Nats sum = start();
    for (std::size_t m = 3; m < std::min(count, value_.size()); ++m) {
      Nats next{};
      next.fill(kImpossible);
      each_step(m, in_time_again, sum, [&](int, int to, double nats) {
        const double most = std::max(next[static_cast<std::size_t>(to)], nats);
        const double least = std::min(next[static_cast<std::size_t>(to)], nats);
        next[static_cast<std::size_t>(to)] = most + std::log1p(std::exp(least - most));
      });
      sum = next;
    }
    const double most = *std::ranges::max_element(sum);
    double all = 0;
    for (const double one : sum) all += std::exp(one - most);
    return most + std::log(all);
  }

  /// The likeliest walk: the number of every new value's message.
  [[nodiscard]] std::vector<std::ptrdiff_t> likeliest(double in_time_again) const {
    Nats best = start();
    std::vector<std::array<std::uint8_t, kStates>> from(value_.size());
    for (std::size_t m = 3; m < value_.size(); ++m) {
      Nats next{};
      next.fill(kImpossible);
      each_step(m, in_time_again, best, [&](int before, int to, double nats) {
        const auto at = static_cast<std::size_t>(to);
        if (!(nats > next[at])) return;
        next[at] = nats;
        from[m][at] = static_cast<std::uint8_t>(before);
      });
      best = next;
    }
    auto state = static_cast<int>(std::ranges::max_element(best) - best.begin());
    std::vector<std::ptrdiff_t> ahead(value_.size(), 1);
    for (std::size_t m = value_.size() - 1; m > 2; --m) {
      ahead[m] = State::of(state).ahead;
      state = from[m][static_cast<std::size_t>(state)];
    }
    std::vector<std::ptrdiff_t> number(value_.size());
    number[2] = static_cast<std::ptrdiff_t>(row_[2]) - State::of(state).late;
    number[1] = number[2] - 1;
    number[0] = number[1] - 1;
    for (std::size_t m = 3; m < value_.size(); ++m) number[m] = number[m - 1] + ahead[m];
    return number;
  }

 private:
  static std::size_t bend_index(int a, int b, int c) {
    return static_cast<std::size_t>(((a - 1) * kMostAhead + b - 1) * kMostAhead + c - 1);
  }
  [[nodiscard]] double bend(std::size_t m, int a, int b, int c) const {
    const BendWeights& weight = bends_[bend_index(a, b, c)];
    return weight[0] * value_[m - 3] + weight[1] * value_[m - 2] + weight[2] * value_[m - 1] + weight[3] * value_[m];
  }
  static Nats start() {
    Nats nats{};
    nats.fill(kImpossible);
    for (int late = 0; late < kLates; ++late) nats[static_cast<std::size_t>(State{late, 1, 1}.index())] = 0;
    return nats;
  }

  /// Calls `step`(from, to, nats) for every step from value m - 1 to value m that a walk of `nats` can go.
  template <class Step>
  void each_step(std::size_t m, double in_time_again, const Nats& nats, Step step) const {
    const double stays = std::log1p(-in_time_again);
    const double returns = std::log(in_time_again);
    const double half_way = std::log(0.1);
    const int waited = static_cast<int>(row_[m] - row_[m - 1]) - 1;
    const double came_late = waited * std::log(static_cast<double>(repeats()) / static_cast<double>(row_.back() + 1));
    for (int from = 0; from < kStates; ++from) {
      const double so_far = nats[static_cast<std::size_t>(from)];
      if (!(so_far > kImpossible)) continue;
      const State state = State::of(from);
      const int late = state.late + waited;
      const auto go = [&](int to_late, int ahead, double prior) {
        if (to_late < 0 || to_late > kMostLate) return;
        const double off = bend(m, state.before, state.ahead, ahead);
        step(from, State{to_late, state.ahead, ahead}.index(), so_far + prior - off * off / (4 * variance_));
      };
      if (late == 0) go(0, 1, 0);
      if (late > 0) go(late, 1, came_late + stays);
      for (int ahead = 2; ahead <= kMostAhead; ++ahead) {
        const int to_late = late - (ahead - 1);
        go(to_late, ahead, came_late + returns + (to_late > 0 ? half_way : 0));
      }
      go(late - 1, 1, -kSlip_nats);
      go(late, 2, -kSlip_nats);
    }
  }

  std::vector<std::size_t> row_;
  std::vector<double> value_;
  std::array<BendWeights, std::size_t{kMostAhead} * kMostAhead * kMostAhead> bends_{};
  double variance_ = 0;
};

}  // namespace

std::optional<MessageNumbers> message_numbers(std::span<const double> values) {
  constexpr std::size_t kFewest = 200;   // rows
  constexpr std::size_t kJudged = 6000;  // new values by which q is chosen
  constexpr std::size_t kLongestWait = std::size_t{kMostLate} + kMostAhead;
  constexpr double kSure_nats = 7;     // a thousand to one
  constexpr double kSlipsARow = 1e-3;  // more, and the sensor has another rate
  constexpr int kTimes = 4;
  constexpr std::array kInTimeAgain = {0.9, 0.5, 0.2, 0.05};
  constexpr double kAtOnce = 0.9999;
  if (values.size() < kFewest) return std::nullopt;
  Walks walks(new_values(values));
  if (walks.repeats() == 0 || walks.rows().size() < values.size() / 2) return std::nullopt;
  for (std::size_t m = 1; m < walks.rows().size(); ++m) {
    if (walks.rows()[m] - walks.rows()[m - 1] > kLongestWait) return std::nullopt;
  }
  walks.take_variance();
  if (!repeats_tell(std::sqrt(walks.variance()), values)) return std::nullopt;
  const double lost = walks.nats(kAtOnce, kJudged);
  double best_q = 0;
  double best = lost + kSure_nats;
  for (const double q : kInTimeAgain) {
    const double nats = walks.nats(q, kJudged);
    if (!(nats > best)) continue;
    best = nats;
    best_q = q;
  }
  if (best_q == 0) return std::nullopt;
  MessageNumbers out{.row = walks.rows()};
  for (int i = 0; i < kTimes; ++i) {  // with messages left out, the first variance is too large
    const double before = walks.variance();
    out.number = walks.likeliest(best_q);
    walks.take_variance(out.number);
    if (!(walks.variance() > 0) || std::abs(walks.variance() / before - 1) < 0.05) break;
  }
  const auto slipped = static_cast<double>(out.number.back() - static_cast<std::ptrdiff_t>(out.row.back()));
  if (std::abs(slipped) > kMostLate + kSlipsARow * static_cast<double>(values.size())) return std::nullopt;
  std::size_t late = 0;
  for (std::size_t m = 0; m < out.row.size(); ++m)
    late += static_cast<std::ptrdiff_t>(out.row[m]) > out.number[m] ? 1 : 0;
  out.late_share = static_cast<double>(late + walks.repeats()) / static_cast<double>(values.size());
  return out;
}

}  // namespace steerid
