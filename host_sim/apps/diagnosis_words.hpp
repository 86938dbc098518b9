// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The diagnosis in words: the sentence on top of the report and on the terminal, and the names in them.
#pragma once

#include <string>
#include <string_view>

#include "gap/diagnosis/diagnosis.hpp"

namespace steerid {

/// "coulomb friction" for "coulomb_friction".
[[nodiscard]] std::string spoken(std::string_view id);

/// "0.482 Nm" of a value and the name that carries its unit: "friction_nm".
[[nodiscard]] std::string in_unit(double value, std::string_view parameter_name);
/// "Nm", "Nms/rad" of "friction_nm", "grip_damping_nms_per_rad"; empty for a pure number.
[[nodiscard]] std::string unit_of(std::string_view parameter_name);
/// "friction" of "friction_nm".
[[nodiscard]] std::string quantity_of(std::string_view parameter_name);

/// "coulomb friction, friction 0.482 Nm": the effect and its first two numbers.
[[nodiscard]] std::string in_short(const gap::Cause& cause);

/// A few sentences: what explains the gap, how much of it is closed, and where the rest lies.
[[nodiscard]] std::string verdict_sentence(const gap::Diagnosis& diagnosis);

/// "delay, lag and compliance" with `last` "and".
[[nodiscard]] std::string joined(const std::vector<std::string>& words, std::string_view last);

/// "delay, lag or compliance" of their ids.
[[nodiscard]] std::string enumerated(const std::vector<std::string>& ids);

/// "12.3 %" of 0.123.
[[nodiscard]] std::string percent(double share);
/// "94 to 99 %".
[[nodiscard]] std::string percent_range(double low, double high);

}  // namespace steerid
