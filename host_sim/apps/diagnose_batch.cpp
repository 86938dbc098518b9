// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/diagnose_batch.hpp"

#include <nlohmann/json.hpp>

#include "apps/made_from.hpp"
#include "log/output_folder.hpp"

namespace steerid {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json answer_of(const DiagnosisFiles& files, const DiagnosisRequest& request) {
  remove_answer(files);  // to another question: if there is none to this one, it would pass for it
  gap::DiagnoseOptions options = request.options();
  options.threads = 1;
  const DiagnosisInputs inputs = read_inputs(files, request, options);
  const Json from = made_from(files, request);
  make_output_folder(files.out);
  return write_diagnosis(diagnosis_of(inputs, files, options), inputs, files, request, from);
}

RecordAnswer answered(const DiagnosisFiles& files, const DiagnosisRequest& request) {
  Json answer = earlier_answer(files, request);
  const bool kept = !answer.is_null();
  if (!kept) answer = answer_of(files, request);
  const Json& from = answer.at("made_from");
  return {.made_from = {{"log", from.at("log")}, {"sim", from.at("sim")}}, .answer = answer, .kept = kept};
}

}  // namespace

void diagnose_batch(const BatchPlace& place, const fs::path& sim, const DiagnosisRequest& request, FilesOfRun& files) {
  (void)request.log.format();  // an option that cannot be read is no record's fault
  Json options = request.json();
  if (!sim.empty()) options["sim"] = fingerprint(sim);  // of all records: shards with others answer another question
  const auto files_of = [&](const fleet::ListedRecord& record, const fs::path& out) {
    return DiagnosisFiles{place.folder / record.log, sim.empty() ? place.folder / record.sim : sim, out};
  };
  run_batch({.command = "diagnose",
             .options = options,
             .label = "diagnosing",
             .answer = [&](const fleet::ListedRecord& record,
                           const fs::path& out) { return answered(files_of(record, out), request); },
             .inputs =
                 [&](const fleet::ListedRecord& record) {
                   const DiagnosisFiles read = files_of(record, {});
                   return std::vector{read.log, read.sim};
                 },
             .outputs = [&](const fs::path& out) { return answer_files(out, request); },
             .remove =
                 [](const fs::path& out) {
                   remove_answer({{}, {}, out});
                 }},
            place, files);
}

}  // namespace steerid
