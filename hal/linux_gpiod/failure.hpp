// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What stops the back end from starting: one sentence that says what failed, where, and what to do about it. Thrown
// before the loop starts only; while it runs, every call answers with a Status.
#pragma once

#include <stdexcept>
#include <string>

namespace steerid::linux_gpiod {

class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// "no permission", "no such device", ... for an errno, with `advice` for what may be done about EACCES and EPERM.
std::string reason(int error_number, const std::string& advice_on_permission);

}  // namespace steerid::linux_gpiod
