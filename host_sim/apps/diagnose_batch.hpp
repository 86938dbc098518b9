// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// `steerid diagnose --batch`: every record of a folder or of a list.
#pragma once

#include <filesystem>

#include "apps/batch_run.hpp"
#include "apps/diagnosis_request.hpp"

namespace steerid {

/// Diagnoses the records of `place` as batch_run.hpp says. `sim`, when it is not empty, is the simulation of them all.
/// An answer that is there already and was made from the same is kept.
void diagnose_batch(const BatchPlace& place, const std::filesystem::path& sim, const DiagnosisRequest& request,
                    FilesOfRun& files);

}  // namespace steerid
