// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The identifier's rate is no setting: half of its constants are counted in samples of it.
// error: error: assignment of read-only variable
#include "identifier/identifier.hpp"

void set(steerid::IdentifierSettings<float>& settings) {
  settings.usable = 0.2F;
#ifdef MUST_NOT_COMPILE
  settings.period_s = 0.02F;
#endif
}
