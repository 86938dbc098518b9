// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// `steerid identify --folder`: every record of a folder or of a list.
#pragma once

#include "apps/batch_run.hpp"
#include "apps/identify_record.hpp"

namespace steerid {

/// Identifies the records of `place` as batch_run.hpp says: OUT/NAME/identification.json and, with `report`,
/// report.html. An answer that is there already and was made from the same is kept.
void identify_folder(const BatchPlace& place, const IdentifyRequest& request, bool report, FilesOfRun& files);

}  // namespace steerid
