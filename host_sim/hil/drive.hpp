// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A drive as an ECU lives it, tick by tick, and the same drive through the task in this process: the reference that the
// ECU's estimates must equal bit for bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "link/messages.hpp"
#include "log/record.hpp"
#include "port/estimate.hpp"
#include "port/sample.hpp"

namespace steerid::hil {

/// What one tick brought to the ECU.
struct TickInput {
  std::optional<Sample> sample;
  bool reset_before = false;  ///< the ECU was reset, and went on from its saved estimate, before this tick
};

/// The record's samples, one entry a tick; empty where the record has a gap.
std::vector<std::optional<Sample>> samples_of(const Record& record);

/// The estimates of the firmware's own loop over these ticks, one each, saving and restoring as the ECU does.
std::vector<Estimate> in_process(const std::vector<TickInput>& ticks, link::Number number);

/// Same bits in every field.
bool same_bits(const Estimate& a, const Estimate& b);

}  // namespace steerid::hil
