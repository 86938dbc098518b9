// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// `steerid study blind`: how good the diagnosis is on records whose answers it cannot know.
#pragma once

#include <CLI/CLI.hpp>

namespace steerid {

/// Adds `blind` and its parts to `study`.
void add_study_blind(CLI::App& study);

}  // namespace steerid
