// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What `steerid identify` prints: the answer as a table to be read by a person.
#pragma once

#include <string>

#include "apps/identification.hpp"

namespace steerid {

/// One method's answer: a line for each parameter (value, standard deviation, unit, state), then natural frequency or
/// why there is none, and how well the model explains the record. Ends with a line feed.
std::string identification_table(const Identification& found);

/// One parameter's line of such a table.
std::string parameter_line(const char* title, const char* unit, const IdentifiedParameter& parameter);

}  // namespace steerid
