// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One quantity over a fleet: its mean, how it spreads between and within vehicles, and how it drifts. From sums, so
// that memory grows neither with the records nor with the vehicles.
//
// Model. y of record i of vehicle v is mean + a_v + slope (x_vi - x) + e_vi, where a_v has the standard deviation
// "between" and e_vi, the record's own error included, "within"; x is days or kilometres.
//   mean     over records
//   within, between   one-way analysis of variance with unequal groups (Searle, Casella and McCulloch 1992, 3.6)
//   slope    within vehicles, which is least squares after each vehicle's means are taken off; where no vehicle has
//            two records, across vehicles, where an old vehicle may differ from a young one for other reasons
//
// Intervals are 95 %, from a delete-a-group jackknife (Kott 2001): vehicles are dealt out to at most 50 groups in turn,
// and an estimate without each group is Student's with one degree less than there are groups. Vehicles stay whole, so
// that records of one vehicle need not be independent. With fewer than four groups there is no interval.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>

#include "fleet/share.hpp"

namespace steerid::fleet {

class Spread {
 public:
  /// What y may drift over.
  enum Clock : std::size_t { kDays, kKilometres };
  static constexpr std::size_t kClocks = 2;

  /// The next record of the vehicle; a clock that nobody read is NaN.
  void add(double y, const std::array<double, kClocks>& clocks);
  /// No more records of this vehicle. `vehicle` is its number in the fleet, from 0.
  void end_vehicle(std::size_t vehicle);

  [[nodiscard]] std::size_t records() const;
  [[nodiscard]] std::size_t vehicles() const;
  [[nodiscard]] Interval mean() const;
  [[nodiscard]] Interval between() const;  ///< NaN where no vehicle has two records
  [[nodiscard]] Interval within() const;   ///< NaN where no vehicle has two records

  struct Drift {
    bool within_vehicles;
    std::size_t records;
    Interval slope;  ///< of y a day or a kilometre
  };
  /// Nothing where fewer than three records have the clock, or all the same.
  [[nodiscard]] std::optional<Drift> drift(Clock clock) const;

 private:
  static constexpr std::size_t kGroups = 50;

  /// Sums over points (x, y), which can be added.
  struct Line {
    double n = 0;
    double x = 0;
    double y = 0;
    double xx = 0;
    double xy = 0;
    Line& operator+=(const Line& other);
    void add(double x_value, double y_value);
    [[nodiscard]] double sxx() const { return n > 0 ? xx - x * x / n : 0; }
    [[nodiscard]] double sxy() const { return n > 0 ? xy - x * y / n : 0; }
  };
  struct Sums {
    double n = 0;
    double vehicles = 0;
    double nn = 0;       // of n squared, over vehicles
    double y = 0;        // of y
    double n_mean2 = 0;  // of n mean^2, over vehicles
    double inside = 0;   // squares about the vehicles' own means
    std::array<Line, kClocks> pooled = {};
    std::array<double, kClocks> inside_xx = {};  // about the vehicles' own means
    std::array<double, kClocks> inside_xy = {};
    std::array<double, kClocks> inside_n = {};  // records of vehicles with two or more
    Sums& operator+=(const Sums& other);
  };

  [[nodiscard]] Sums total() const;
  [[nodiscard]] Interval jackknifed(const std::function<double(const Sums&)>& estimate) const;

  std::array<Sums, kGroups> groups_ = {};
  // Of the vehicle that is being added.
  double n_ = 0;
  double mean_ = 0;
  double squares_ = 0;
  std::array<Line, kClocks> lines_ = {};
  // The first values seen, from which all are counted: a date has five digits and a drift is small.
  std::optional<double> y_zero_;
  std::array<std::optional<double>, kClocks> x_zero_;
};

}  // namespace steerid::fleet
