// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a fleet's report keeps of many records without growing with them: a fair sample, and those that come first.
#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

namespace steerid::fleet {

/// Each of the items that were added is kept with equal probability, all of them while they are no more than `room`
/// (algorithm R, Vitter 1985). The same items in the same order give the same sample.
template <class T>
class Sample {
 public:
  explicit Sample(std::size_t room) : room_(room) {}

  void add(T item) {
    ++seen_;
    if (kept_.size() < room_) {
      kept_.push_back(std::move(item));
    } else if (const std::size_t place = draw_() % seen_; place < room_) {
      kept_[place] = std::move(item);
    }
  }

  [[nodiscard]] const std::vector<T>& kept() const { return kept_; }
  [[nodiscard]] std::size_t seen() const { return seen_; }

 private:
  std::size_t room_;
  std::size_t seen_ = 0;
  std::vector<T> kept_;
  std::mt19937_64 draw_{1};  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same answers give the same report
};

/// The items of the largest keys, the largest first; of equal ones those that came first.
template <class T>
class Foremost {
 public:
  explicit Foremost(std::size_t room) : room_(room) {}

  void add(double key, T item) {
    if (items_.size() == room_ && !(key > items_.back().first)) return;
    const auto place = std::ranges::upper_bound(items_, key, std::greater<>(), &std::pair<double, T>::first);
    items_.emplace(place, key, std::move(item));
    if (items_.size() > room_) items_.pop_back();
  }

  [[nodiscard]] const std::vector<std::pair<double, T>>& items() const { return items_; }

 private:
  std::size_t room_;
  std::vector<std::pair<double, T>> items_;
};

/// Of values in any order, between neighbours in proportion; NaN of none.
[[nodiscard]] double quantile(std::vector<double> values, double part);

}  // namespace steerid::fleet
