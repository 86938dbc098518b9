// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What can be wrong with a record that a reader lets through: stamps, gaps, length, units, channels. Every mutation
// keeps the promises of a Record (columns of equal length, finite values, stamps that increase).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "log/record.hpp"

namespace steerid::test {

class Mutations {
 public:
  explicit Mutations(std::uint64_t seed) : bits_(seed) {}

  /// One to three of them, one after the other; `says` gets their names.
  Record of(Record record, std::string& says) {
    using Mutation = void (Mutations::*)(Record&);
    static constexpr std::array<std::pair<const char*, Mutation>, 16> kAll = {{
        {"late stamps", &Mutations::delay_stamps},
        {"stalled stamps", &Mutations::stall_stamps},
        {"crowded stamps", &Mutations::crowd_stamps},
        {"a clock that wanders", &Mutations::wander},
        {"a clock that jumps", &Mutations::jump},
        {"lost rows", &Mutations::lose_rows},
        {"gaps", &Mutations::cut_gaps},
        {"a piece", &Mutations::keep_a_piece},
        {"every other row", &Mutations::halve},
        {"another unit of time", &Mutations::other_time},
        {"another unit of angle", &Mutations::other_angle},
        {"another unit of torque", &Mutations::other_torque},
        {"a channel turned round", &Mutations::turn},
        {"a coarse angle", &Mutations::coarsen},
        {"a channel that stays", &Mutations::hold},
        {"one wild value", &Mutations::spike},
    }};
    for (std::size_t left = 1 + below(3); left > 0; --left) {
      const auto& [name, mutation] = kAll[below(kAll.size())];
      says += (says.empty() ? "" : ", ") + std::string(name);
      (this->*mutation)(record);
    }
    for (std::size_t i = 1; i < record.size(); ++i) {  // as a reader demands
      record.time_s[i] = std::max(record.time_s[i], std::nextafter(record.time_s[i - 1], 1e300));
    }
    return record;
  }

 private:
  double uniform() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(bits_() % count); }
  /// From 10^low to 10^high, evenly in the exponent.
  double decade(double low, double high) { return std::pow(10, low + (high - low) * uniform()); }
  static double period_s(const Record& record) {
    return (record.time_s.back() - record.time_s.front()) / static_cast<double>(record.size());
  }
  static std::array<std::vector<double>*, 4> columns(Record& record) {
    return {&record.time_s, &record.torque_driver_nm, &record.torque_motor_nm, &record.angle_rad};
  }
  std::vector<double>& channel(Record& record) { return *columns(record)[1 + below(3)]; }

  static void keep(Record& record, const std::function<bool(std::size_t)>& wanted) {
    std::vector<char> kept;
    for (std::size_t i = 0; i < record.size(); ++i) kept.push_back(wanted(i) ? 1 : 0);
    for (std::vector<double>* column : columns(record)) {
      std::size_t i = 0;
      std::erase_if(*column, [&](double) { return kept[i++] == 0; });
    }
  }

  void delay_stamps(Record& record) {
    const double late_s = period_s(record) * decade(-3, 1);
    for (double& t : record.time_s) t += late_s * uniform();
  }
  void stall_stamps(Record& record) {
    const double longest_s = period_s(record) * decade(0, 2);
    double free_s = record.time_s.front();
    for (double& t : record.time_s) {
      if (uniform() < 0.02) free_s = t + longest_s * uniform();
      t = std::max(t, free_s);
    }
  }
  void crowd_stamps(Record& record) {
    const std::size_t burst = 2 + below(50);
    for (std::size_t i = 0; i < record.size(); ++i) {
      const std::size_t last = std::min(record.size() - 1, i - i % burst + burst - 1);
      record.time_s[i] = record.time_s[last] + 1e-7 * static_cast<double>(i % burst);
    }
  }
  void wander(Record& record) {
    const double by_s = decade(-4, 0);
    const double begin_s = record.time_s.front();
    for (double& t : record.time_s) t += by_s * std::sin(0.7 * (t - begin_s));
  }
  void jump(Record& record) {
    const std::size_t at = below(record.size());
    const double by_s = decade(-2, 9);
    for (std::size_t i = at; i < record.size(); ++i) record.time_s[i] += by_s;
  }
  void lose_rows(Record& record) {
    const double share = 0.5 * uniform();
    keep(record, [&](std::size_t) { return uniform() >= share; });
  }
  void cut_gaps(Record& record) {
    const std::size_t every = 20 + below(1000);
    const std::size_t missing = 1 + below(every - 5);
    keep(record, [&](std::size_t i) { return i % every >= missing; });
  }
  void keep_a_piece(Record& record) {
    const std::size_t first = below(record.size());
    const std::size_t count = 1 + below(record.size() - first);
    keep(record, [&](std::size_t i) { return first <= i && i < first + count; });
  }
  void halve(Record& record) {
    keep(record, [](std::size_t i) { return i % 2 == 0; });
  }
  void other_time(Record& record) {
    const double factor = decade(-3, 3);
    for (double& t : record.time_s) t *= factor;
  }
  void other_angle(Record& record) {
    const double factor = decade(-6, 6);
    for (double& angle : record.angle_rad) angle *= factor;
  }
  void other_torque(Record& record) {
    const double factor = decade(-6, 6);
    for (double& torque : record.torque_motor_nm) torque *= factor;
  }
  void turn(Record& record) {
    for (double& value : channel(record)) value = -value;
  }
  void coarsen(Record& record) {
    const double step = decade(-4, -1);
    for (double& angle : record.angle_rad) angle = step * std::round(angle / step);
  }
  void hold(Record& record) {
    std::vector<double>& held = channel(record);
    const std::size_t from = below(held.size());
    for (std::size_t i = from; i < held.size(); ++i) held[i] = held[from];
  }
  void spike(Record& record) {
    std::vector<double>& in = channel(record);
    in[below(in.size())] = (uniform() < 0.5 ? -1 : 1) * decade(0, 12);
  }

  std::mt19937_64 bits_;
};

}  // namespace steerid::test
