// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What is counted over a fleet, one of these for each change, quantity, place and reason. Each is as large after many
// records as after few.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "fleet/record_facts.hpp"
#include "fleet/sample.hpp"
#include "fleet/shard_file.hpp"
#include "fleet/share.hpp"
#include "fleet/spread.hpp"

namespace steerid::fleet {

/// A record beside one of its numbers.
struct RecordNumber {
  std::string record;
  std::string vehicle;
  double number = std::numeric_limits<double>::quiet_NaN();
  std::array<double, Spread::kClocks> clocks = {};  ///< NaN where nobody says
};

/// How many records of a kind are named on the page.
inline constexpr std::size_t kListed = 25;
/// How many values are kept for quantiles and charts: a median of so many lies within 1.6 % of the true one's rank.
inline constexpr std::size_t kSampled = 2000;

/// A change, or one of the verdicts none, parameters and unknown.
class ChangeTally {
 public:
  void add(const ChangeFact& fact, const RecordNumber& record);
  void end_vehicle(std::size_t vehicle);

  [[nodiscard]] const Share& share() const { return share_; }
  [[nodiscard]] const Spread& probability() const { return probability_; }
  [[nodiscard]] std::size_t named() const { return named_; }  ///< records that have it more likely than not
  [[nodiscard]] std::size_t naming_vehicles() const { return vehicles_; }  ///< vehicles with such a record
  [[nodiscard]] const Foremost<RecordNumber>& clearest() const { return clearest_; }

 private:
  Share share_;
  Spread probability_;
  std::size_t named_ = 0;
  std::size_t vehicles_ = 0;
  bool vehicle_named_ = false;
  Foremost<RecordNumber> clearest_{kListed};
};

/// A vehicle's mean of a quantity, and the record that is farthest out.
struct VehicleMean {
  std::string vehicle;
  double mean = 0;
  double records = 0;
  RecordNumber extreme;
};

class QuantityTally {
 public:
  void add(double value, RecordNumber record);
  void end_vehicle(std::size_t vehicle);

  [[nodiscard]] const Spread& spread() const { return spread_; }
  [[nodiscard]] const Sample<RecordNumber>& sample() const { return sample_; }
  [[nodiscard]] const Foremost<RecordNumber>& smallest() const { return smallest_; }
  [[nodiscard]] const Foremost<RecordNumber>& largest() const { return largest_; }

  /// How the vehicles' means are centred and spread: median, and 1.4826 median absolute deviations, which is the
  /// standard deviation of a normal spread (Rousseeuw and Croux 1993). NaN with fewer than ten vehicles.
  struct Usual {
    double median;
    double sd;
  };
  [[nodiscard]] Usual usual() const;
  /// Vehicles whose mean is farther out than one vehicle in twenty fleets of this size would be, were the means spread
  /// normally (Bonferroni); the farthest first.
  [[nodiscard]] std::vector<VehicleMean> outliers() const;

 private:
  Spread spread_;
  Sample<RecordNumber> sample_{kSampled};
  Sample<double> means_{kSampled};
  Foremost<RecordNumber> smallest_{kListed};
  Foremost<RecordNumber> largest_{kListed};
  Foremost<VehicleMean> low_{kListed};
  Foremost<VehicleMean> high_{kListed};
  VehicleMean now_;
  RecordNumber least_;
  RecordNumber most_;
};

/// Where unexplained gaps lie. Places are counted by axis, sign and octave; neighbours on an axis form one cluster.
class PlaceTally {
 public:
  void add(const PlaceFact& place, const RecordNumber& record);

  struct Cluster {
    std::string axis;
    std::string unit;
    double low = 0;  ///< of all ranges in it
    double high = 0;
    std::size_t records = 0;
    std::vector<RecordNumber> examples = {};
  };
  /// The largest first.
  [[nodiscard]] std::vector<Cluster> clusters() const;

 private:
  std::map<std::pair<std::string, int>, Cluster> places_;  // by axis and octave
};

/// Why records have no answer: sentences alike but for names and numbers are one reason.
class ReasonTally {
 public:
  void add(const std::string& sentence, bool fault, const RecordNumber& record);

  struct Reason {
    std::string sentence;
    bool fault = false;
    std::size_t records = 0;
    std::vector<RecordNumber> examples = {};
  };
  /// The most frequent first.
  [[nodiscard]] std::vector<Reason> reasons() const;

 private:
  std::map<std::string, Reason> reasons_;
};

}  // namespace steerid::fleet
