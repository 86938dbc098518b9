// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/slipped_messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "log/bend.hpp"
#include "log/channel_noise.hpp"

namespace steerid {
namespace {

constexpr std::size_t kMostMissing = 3;

/// What four messages in a row are off a parabola, in nats.
class Bends {
 public:
  explicit Bends(const std::vector<double>& messages) : messages_(messages) {
    for (std::size_t missing = 0; missing < weights_.size(); ++missing) {
      const auto gap = static_cast<double>(missing);
      weights_[missing] = {bend_weights({0, 1, 2, 3 + gap}), bend_weights({0, 1, 2 + gap, 3 + gap}),
                           bend_weights({0, 1 + gap, 2 + gap, 3 + gap})};
    }
    double squares = 0;
    for (std::size_t m = kReach; m + kReach <= messages.size(); ++m) squares += 4.0 / kReach * nats(m, 0);
    variance_ = squares / static_cast<double>(messages.size());
  }
  static constexpr std::size_t kReach = 3;  // messages on either side

  /// Of the three around a place before message m, at which so many are missing. They share messages: each counts half.
  [[nodiscard]] double nats(std::size_t m, std::size_t missing) const {
    double squares = 0;
    for (std::size_t i = 0; i < kReach; ++i) {
      const BendWeights& weight = weights_[missing][i];
      const auto first = messages_.begin() + static_cast<std::ptrdiff_t>(m + i) - kReach;
      squares += std::pow(std::inner_product(weight.begin(), weight.end(), first, 0.0), 2);
    }
    return squares / (4 * variance_);
  }
  /// Of the step to message m being no mean of what those before and those behind it make of it, as it is where the
  /// rate changes at once.
  [[nodiscard]] double nats_beyond_a_kink(std::size_t m) const {
    constexpr double kSquares = 20;  // of a third difference's weights
    const auto step = [&](std::size_t i) { return messages_[i] - messages_[i - 1]; };
    const auto [least, most] = std::minmax({2 * step(m - 1) - step(m - 2), 2 * step(m + 1) - step(m + 2)});
    const double beyond = step(m) - std::clamp(step(m), least, most);
    return beyond * beyond / (2 * kSquares * variance_);
  }
  [[nodiscard]] double variance() const { return variance_; }

 private:
  const std::vector<double>& messages_;
  std::array<std::array<BendWeights, kReach>, kMostMissing + 1> weights_{};
  double variance_ = 1;
};

}  // namespace

std::optional<MessageNumbers> slipped_numbers(std::span<const double> values, bool inert) {
  constexpr std::size_t kFewest = 200;  // rows
  constexpr double kSteps = 10;         // of noise, as in log/late_messages.cpp
  constexpr double kRepeatsARow = 1e-3;
  constexpr double kSlipsARow = 3e-4;  // three times what crystals of 100 ppm make
  constexpr double kSure_nats = 7;     // a thousand to one
  constexpr double kFits_nats = 4.5;   // 3 deviations
  if (values.size() < kFewest) return std::nullopt;
  MessageNumbers out;
  std::vector<double> messages;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0 && values[i] == values[i - 1]) continue;
    out.row.push_back(i);
    messages.push_back(values[i]);
  }
  const auto rows = static_cast<double>(values.size());
  if (static_cast<double>(values.size() - messages.size()) > std::max(3.0, kRepeatsARow * rows)) return std::nullopt;
  const Bends bends(messages);
  if (!(std::sqrt(bends.variance()) > kSteps * smallest_step(values))) return std::nullopt;
  std::ptrdiff_t slipped = 0;
  bool any_skipped = false;
  bool any_repeated = false;
  for (std::size_t m = 0; m < messages.size(); ++m) {
    if (m >= Bends::kReach && m + Bends::kReach <= messages.size()) {
      const std::size_t repeats = out.row[m] - out.row[m - 1] - 1;
      const std::size_t missing = repeats == 0 ? 1 : std::min(repeats, kMostMissing);
      const double with_none = bends.nats(m, 0);
      const double with_missing = bends.nats(m, missing);
      const bool skipped =
          repeats == 0 && inert && with_missing < kFits_nats &&
          std::min(with_none - with_missing, bends.nats_beyond_a_kink(m)) > kSure_nats + std::log(rows);
      const bool repeated = repeats > 0 && with_missing - with_none > kSure_nats;
      if (skipped) ++slipped;
      if (repeated) slipped -= static_cast<std::ptrdiff_t>(repeats);
      if (skipped || repeated) out.slips.push_back(out.row[m]);
      any_skipped = any_skipped || skipped;
      any_repeated = any_repeated || repeated;
    }
    out.number.push_back(static_cast<std::ptrdiff_t>(out.row[m]) + slipped);
  }
  if (any_skipped == any_repeated) return std::nullopt;  // one clock is the faster one
  if (static_cast<double>(out.slips.size()) > 1 + kSlipsARow * rows) return std::nullopt;
  if (any_skipped) {  // what comes behind the first is of its own row
    for (std::ptrdiff_t& number : out.number) --number;
  }
  return out;
}

}  // namespace steerid
