// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What is said of a record whose numbers cannot be a steering wheel in the units they are taken in.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fit/unit_check.hpp"
#include "log/record.hpp"
#include "log/record_quality.hpp"

namespace steerid {

/// A sentence that names the option to use; empty when the units are plausible, the user has stated them after a colon,
/// or the record is of a slide.
[[nodiscard]] std::string unit_words(const UnitCheck& check, const RecordQuality& seen);

/// A sentence on how late the torques are; empty when they are not.
[[nodiscard]] std::string delay_words(const TorqueDelay& delay);

/// What a sentence begins with behind which stands what a record's columns cannot be.
inline constexpr std::string_view kNotCredible = "not credible: ";

/// What is noticed of a record that is read, a sentence each: what was taken for granted, and with kNotCredible before
/// it a doubt. `record` is at 100 Hz.
[[nodiscard]] std::vector<std::string> read_notes(const Record& record, const RecordQuality& seen);

}  // namespace steerid
