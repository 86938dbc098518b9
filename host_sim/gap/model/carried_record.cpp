// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/carried_record.hpp"

namespace steerid::gap {

SpectralRecord carried_record(const SpectralRecord& record, SimulatedModel& model, const Point& at,
                              double smoothing_hz) {
  SpectralRecord carried = record;
  if (record.anew_each_block) return carried;
  const std::span<const double> run_rad = model.run(at);
  if (!run_rad.empty()) carried.motion = motion_carried_by(record.record, run_rad, record.motion, smoothing_hz);
  return carried;
}

}  // namespace steerid::gap
