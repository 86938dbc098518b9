// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A Status that nobody looks at is a fault: what can fail must be asked whether it did.
// error: error: ignoring return
#include "base/status.hpp"

namespace {
steerid::Status kick() { return steerid::Status::kOk; }
}  // namespace

bool use() {
#ifdef MUST_NOT_COMPILE
  kick();
#endif
  return kick() == steerid::Status::kOk;
}
