// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the records of a fleet have in common: from their lines, one after the other in the order of a merge, in memory
// that does not grow with their number.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fleet/answer_table.hpp"
#include "fleet/fleet_table.hpp"
#include "fleet/shard_file.hpp"
#include "fleet/tallies.hpp"

namespace steerid::fleet {

class Summary {
 public:
  explicit Summary(const AnswerKind& kind) : kind_(kind) {}

  /// The next record, by vehicle and then by name. One without a vehicle is a vehicle of its own.
  void add(const RecordLine& line);
  /// After the last record.
  void finish() { end_vehicle(); }

  using ChangeName = std::pair<std::string, std::string>;  // effect and change

  [[nodiscard]] const AnswerKind& kind() const { return kind_; }
  [[nodiscard]] std::size_t records() const { return records_; }
  [[nodiscard]] std::size_t answered() const { return answered_; }
  [[nodiscard]] std::size_t faults() const { return faults_; }
  [[nodiscard]] std::size_t vehicles() const { return vehicles_; }  ///< with an answered record
  [[nodiscard]] bool named_vehicles() const { return named_vehicles_; }
  [[nodiscard]] const std::map<ChangeName, ChangeTally>& changes() const { return changes_; }
  [[nodiscard]] const std::map<std::string, QuantityTally>& quantities() const { return quantities_; }
  [[nodiscard]] const QuantityTally& closed() const { return closed_; }
  [[nodiscard]] const PlaceTally& unknown() const { return unknown_; }
  [[nodiscard]] const ReasonTally& refused() const { return refused_; }
  [[nodiscard]] const ReasonTally& doubted() const { return doubted_; }

 private:
  void end_vehicle();
  void add_answer(const RecordLine& line, const RecordNumber& record);

  const AnswerKind& kind_;
  std::size_t records_ = 0;
  std::size_t answered_ = 0;
  std::size_t faults_ = 0;
  std::size_t vehicles_ = 0;
  bool named_vehicles_ = false;
  std::string vehicle_;      // of the last record
  bool in_vehicle_ = false;  // an answered record of it has been added
  std::map<ChangeName, ChangeTally> changes_;
  std::map<std::string, QuantityTally> quantities_;
  QuantityTally closed_;
  PlaceTally unknown_;
  ReasonTally refused_;
  ReasonTally doubted_;
};

}  // namespace steerid::fleet
