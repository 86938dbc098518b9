// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The charts of the diagnosis' page.
#pragma once

#include "gap/diagnosis/diagnosis.hpp"
#include "report/page.hpp"

namespace steerid {

/// Measured and simulated, before and after, over the ten seconds of the held-out part where they differ most.
[[nodiscard]] report::LineChart closer_look_chart(const gap::Diagnosis& diagnosis);

/// How sure each change is, the likeliest ones.
[[nodiscard]] report::Bars probability_chart(const gap::Diagnosis& diagnosis);

/// What each change that is named closes of the gap, and what is left.
[[nodiscard]] report::Bars budget_chart(const gap::Diagnosis& diagnosis);

/// The gap along the axis that tells most, and the angle-velocity map before and after.
void add_place_charts(const gap::Diagnosis& diagnosis, report::Page& page);
void add_other_axes(const gap::Diagnosis& diagnosis, report::Page& page);

/// Measured less simulated over the whole record.
[[nodiscard]] report::LineChart residual_chart(const gap::Diagnosis& diagnosis);

[[nodiscard]] report::LineChart spectrum_chart(const gap::Diagnosis& diagnosis);

}  // namespace steerid
