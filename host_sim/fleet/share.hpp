// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// In what share of a fleet's records something is the case, when each record only knows it with a probability.
//
// Model. In vehicle v a record has the change with probability q_v; over the fleet logit q_v is normal, with a mean and
// a standard deviation s that nobody knows. A record that gave probability p under the prior p0 has the likelihood
// ratio
//   b = (p / (1 - p)) / (p0 / (1 - p0)),
// so that vehicle v has the likelihood
//   L_v = E over q_v of the product over its records of (q_v b + 1 - q_v).
// The share is the mean of q_v over the fleet. Its prior is Jeffreys' for a share, Beta(1/2, 1/2), and s is 0.5, 2 or 8
// with equal probability: from a fleet that is all alike to one in which a vehicle always has the change or never.
// Where every vehicle has one record, s makes no difference. Records of one vehicle are independent given q_v.
//
// The likelihood is kept at 81 shares and brought to the peak by interpolation, so that memory grows neither with the
// records nor with the vehicles. A vehicle costs 14,000 multiplications, a record 200.
//
// A p nearer than 1e-6 to 0 or 1 is taken as 1e-6 from it: no record counts for more than that.
#pragma once

#include <array>
#include <cstddef>

namespace steerid::fleet {

/// A value with its 95 % interval; NaN where there is none.
struct Interval {
  double value;
  double low;
  double high;
};

class Share {
 public:
  static constexpr std::size_t kShares = 81;
  static constexpr std::size_t kSpreads = 3;

  Share();

  /// The next record of the vehicle. `probability` in [0, 1] was given under `prior` in (0, 1).
  void add(double probability, double prior);
  /// No more records of this vehicle.
  void end_vehicle();

  /// Mean and 95 % interval of the share, after the last end_vehicle(). Without a record the prior's.
  [[nodiscard]] Interval interval() const;

 private:
  static constexpr std::size_t kNodes = 57;  // of logit q_v
  using PerNode = std::array<double, kNodes>;
  using PerShare = std::array<double, kSpreads * kShares>;
  struct Grid;
  static const Grid& grid();
  void take_logarithm();

  PerNode vehicle_ = {};   // the product over its records, scaled
  PerShare product_ = {};  // of the last vehicles
  PerShare log_ = {};      // of the vehicles before them
  std::size_t held_ = 0;   // vehicles in product_
  bool empty_ = true;      // the vehicle has no record
};

}  // namespace steerid::fleet
