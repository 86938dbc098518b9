// `steerid diagnose --batch`: every record of a folder, on all cores.
#pragma once

#include <filesystem>

#include "apps/diagnosis_request.hpp"
#include "apps/files_of_run.hpp"

namespace steerid {

/// Diagnoses the records in `folder` into folders of `out`, one a record and called like it, with table.csv beside
/// them. A record is a folder with log.csv and sim.json, or NAME.csv beside NAME.json; `sim`, when it is not empty, is
/// the simulation of them all. An answer that is there already and was made from the same is kept. A record that cannot
/// be used does not keep the others from being diagnosed.
///
/// Throws BadOption when an answer would lie where a record does, BadInput when there is nothing to diagnose, nowhere
/// to write, or when a record was not usable; and std::runtime_error when this program was at fault in one.
void diagnose_batch(const std::filesystem::path& folder, const std::filesystem::path& sim,
                    const std::filesystem::path& out, const DiagnosisRequest& request, FilesOfRun& files);

}  // namespace steerid
