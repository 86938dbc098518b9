// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The probe that a diagnosis proposes, as a file holds it:
//
//   {"rms_nm": 1.5, "low_hz": 0.2, "high_hz": 5, "period_s": 10, "duration_s": 60}
//
// or a whole diagnosis.json, which has it under "next_experiment" as "probe".
#pragma once

#include <filesystem>

#include "experiment/multisine.hpp"

namespace steerid {

struct PlannedProbe {
  MultisineSettings multisine;
  double duration_s = 60;
};

/// Throws BadInput, one sentence, when the file holds no such probe or one that cannot be played.
[[nodiscard]] PlannedProbe load_probe(const std::filesystem::path& file);

}  // namespace steerid
