// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A stuck channel: from the onset on it repeats, for `length_s`, the last value that it delivered before.
#pragma once

#include "sensors/during.hpp"

namespace steerid::sensor {

struct Stuck {
  During during{0.0, 0.0};  ///< length 0 is off
};

}  // namespace steerid::sensor
