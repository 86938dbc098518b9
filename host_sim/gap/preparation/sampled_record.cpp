// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/preparation/sampled_record.hpp"

#include <cmath>

#include "log/record_quality.hpp"
#include "log/resample.hpp"

namespace steerid::gap {
namespace {

/// Every gap-free stretch in equal pieces.
std::vector<GapFreeRows> pieces_of(const Record& record) {
  std::vector<GapFreeRows> pieces;
  for (const GapFreeRows& rows : gap_free_rows(record)) {
    const double length_s = static_cast<double>(rows.size()) / kResampledRateHz;
    const auto count = static_cast<std::size_t>(std::max(1.0, std::round(length_s / kPiece_s)));
    for (std::size_t i = 0; i < count; ++i) {
      pieces.push_back({rows.begin + i * rows.size() / count, rows.begin + (i + 1) * rows.size() / count});
    }
  }
  return pieces;
}

}  // namespace

Record sampled_record(Record record) {
  const auto most = static_cast<std::size_t>(kLongest_s * kResampledRateHz);
  if (record.size() <= most) return record;
  const std::vector<GapFreeRows> pieces = pieces_of(record);
  const std::size_t kept = std::max<std::size_t>(1, pieces.size() * most / record.size());
  Record out;
  out.motor_channel = record.motor_channel;
  for (std::size_t i = 0; i < kept; ++i) {
    const GapFreeRows& piece = pieces[i * pieces.size() / kept];
    for (const auto column :
         {&Record::time_s, &Record::torque_driver_nm, &Record::torque_motor_nm, &Record::angle_rad}) {
      const auto from = (record.*column).begin();
      (out.*column)
          .insert((out.*column).end(), from + static_cast<std::ptrdiff_t>(piece.begin),
                  from + static_cast<std::ptrdiff_t>(piece.end));
    }
  }
  return out;
}

}  // namespace steerid::gap
