// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One record and its simulation as `steerid diagnose` reads, diagnoses and answers them, alone or in a batch.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/log_options.hpp"
#include "gap/diagnosis/diagnosis.hpp"
#include "gap/diagnosis/predicted_simulation.hpp"
#include "gap/diagnosis/together.hpp"
#include "log/log_format.hpp"
#include "log/record.hpp"
#include "plant/simulation.hpp"

namespace steerid {

/// What is asked of every record; columns and signs in the words of their options.
struct DiagnosisRequest {
  LogOptions log;
  std::uint64_t seed = 1;
  std::vector<std::string> without;
  bool report = true;
  double time_limit_s = 300;  ///< of one record

  /// The time limit runs from this call on.
  [[nodiscard]] gap::DiagnoseOptions options() const;
  /// As in made_from().
  [[nodiscard]] nlohmann::ordered_json json() const;
};

struct DiagnosisFiles {
  std::filesystem::path log;
  std::filesystem::path sim;
  std::filesystem::path out;                     ///< the folder of the answer
  std::filesystem::path pred{};                  ///< what a simulation predicts, in place of `sim`; else empty
  std::vector<std::filesystem::path> further{};  ///< records of the same wheel, diagnosed together with `log`

  [[nodiscard]] const std::filesystem::path& simulated() const { return pred.empty() ? sim : pred; }
};

/// All that an answer hangs on: this very program, the request, and what stood in the two files.
///   {"program": sha256, "options": {..}, "log": {"bytes":, "sha256":}, "sim": {..}}       "pred" in place of "sim"
/// An answer that was made from the same is the same. Throws BadInput when a file cannot be read.
[[nodiscard]] nlohmann::ordered_json made_from(const DiagnosisFiles& files, const DiagnosisRequest& request);

struct DiagnosisInputs {
  Simulation sim;
  Record record;
  std::vector<gap::NamedRecord> further{};
  std::vector<std::string> notes;                       ///< of the reader
  std::string doubt{};                                  ///< why no answer is credible, with the record's name before it
                                                        ///< where there are several; else empty
  std::string own_torque{};                             ///< see own_torque_words(), of the first record
  std::optional<gap::PredictedSimulation> predicted{};  ///< where `sim` is what a prediction says of its simulation
};

/// What a simulation has in it that is known by its prediction is found here, too, by the same options as the gap.
/// Throws BadInput.
[[nodiscard]] DiagnosisInputs read_inputs(const DiagnosisFiles& files, const DiagnosisRequest& request,
                                          const gap::DiagnoseOptions& options);

struct DiagnosisOutcome {
  gap::Diagnosis diagnosis;                                            ///< of `log`
  nlohmann::ordered_json together = nlohmann::ordered_json::object();  ///< with further records; else empty
};

/// Throws BadInput, the record's name in front.
[[nodiscard]] DiagnosisOutcome diagnosis_of(const DiagnosisInputs& inputs, const DiagnosisFiles& files,
                                            const gap::DiagnoseOptions& options);

/// The answer, and what it was made of: the input, the options and the program.
[[nodiscard]] nlohmann::ordered_json answer_json(const gap::Diagnosis& diagnosis, const DiagnosisFiles& files,
                                                 const DiagnosisRequest& request);

/// Writes report.html where it is asked for, sim_with_effect.json, and diagnosis.json last: where that one stands the
/// others do. It holds `made_from`, as it was when `inputs` were read, beside the answer. Gives what diagnosis.json
/// says.
nlohmann::ordered_json write_diagnosis(const DiagnosisOutcome& outcome, const DiagnosisInputs& inputs,
                                       const DiagnosisFiles& files, const DiagnosisRequest& request,
                                       const nlohmann::ordered_json& made_from);

/// What diagnosis.json says when it was made from the same, is whole, and its companions are there; null otherwise.
[[nodiscard]] nlohmann::ordered_json earlier_answer(const DiagnosisFiles& files, const DiagnosisRequest& request);

/// The files that write_diagnosis() writes into `out`.
[[nodiscard]] std::vector<std::filesystem::path> answer_files(const std::filesystem::path& out,
                                                              const DiagnosisRequest& request);

/// Takes away what write_diagnosis() has written earlier, and the folder when nothing else is in it.
void remove_answer(const DiagnosisFiles& files);

}  // namespace steerid
