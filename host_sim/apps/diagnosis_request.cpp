// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/diagnosis_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "apps/channel_words.hpp"
#include "apps/diagnosis_page.hpp"
#include "apps/made_from.hpp"
#include "apps/prediction_file.hpp"
#include "apps/unit_words.hpp"
#include "fit/unit_check.hpp"
#include "fleet/answer_table.hpp"
#include "gap/diagnosis/diagnosis_json.hpp"
#include "log/bad_input.hpp"
#include "log/log_reader.hpp"
#include "log/output_folder.hpp"
#include "log/resample.hpp"
#include "log/whole_file.hpp"
#include "plant/driving_torques.hpp"
#include "plant/json_text.hpp"
#include "report/page.hpp"

namespace steerid {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* kAnswer = "diagnosis.json";
constexpr const char* kSimulation = "sim_with_effect.json";
constexpr const char* kReport = "report.html";

/// What the table of a batch is made of stands in it.
bool is_diagnosis(const Json& answer) {
  try {
    (void)fleet::kind_of("diagnose").cells(answer);
    return true;
  } catch (const Json::exception&) {
    return false;
  }
}

/// What the simulation behind a prediction has in it.
void understand_prediction(const DiagnosisFiles& files, const gap::DiagnoseOptions& options, DiagnosisInputs& inputs) {
  const std::vector<double> predicted_rad = read_prediction(files.pred, inputs.record);
  try {
    inputs.predicted = predicted_simulation(inputs.record, predicted_rad, options);
  } catch (const BadInput& error) {
    throw BadInput(fmt::format("{}: {}", files.pred.string(), error.what()));
  }
  inputs.sim = inputs.predicted->simulation;
  constexpr double kPlainly = 0.01;  // of the prediction, rms: what a hundredth of a gap is told from
  if (inputs.predicted->missed_nrmse > kPlainly) {
    inputs.notes.push_back(
        fmt::format("the predicted angle holds what no effect of the vocabulary explains, {:.1f} % of it: {}",
                    100 * inputs.predicted->missed_nrmse,
                    inputs.predicted->remainder.time_s.empty()
                        ? "the nearest simulation is compared in its place"
                        : "every run shown here includes that, sim_with_effect.json does not"));
  }
}

Json prediction_json(const gap::PredictedSimulation& predicted) {
  return {{"nrmse", predicted.prediction_nrmse},
          {"missed_nrmse", predicted.missed_nrmse},
          {"verdict", predicted.found.verdict},
          {"probability", probability_of_answer(predicted.found)},
          {"simulation", Json::parse(predicted.simulation.to_json())}};
}

/// What is noticed of a record at 100 Hz, with what drives a simulation on it. `name` stands before it where there are
/// several records; else it is empty.
void take_notes(const Record& record, const RecordQuality& seen, const std::string& name, DiagnosisInputs& inputs) {
  const std::string of = name.empty() ? "" : name + ": ";
  std::vector<std::string> notes = read_notes(record, seen);
  if (std::string words = driving_words(record); !words.empty()) notes.push_back(std::move(words));
  for (const std::string& note : notes) {
    if (inputs.doubt.empty() && note.starts_with(kNotCredible)) inputs.doubt = of + note.substr(kNotCredible.size());
    inputs.notes.push_back(of + note);
  }
}

/// A record whose columns make no steering wheel beside a simulation of one: a unit is another one, and what would be
/// found of the gap is what makes up for it best.
void require_units_of(const Simulation& sim, const Record& record, const RecordQuality& seen, const std::string& name) {
  const UnitCheck check = check_units(record);
  const bool is_wheel = sim.wheel.inertia_kgm2 >= kLightestKgm2 && sim.wheel.inertia_kgm2 <= kHeaviestKgm2;
  if (!is_wheel || check.verdict == UnitCheck::Verdict::kTurnsTooFar) return;
  if (const std::string words = unit_words(check, seen); !words.empty()) {
    throw BadInput(fmt::format("{}: the simulation is of a wheel of {:.2g} kg m2 and the record of none: {}", name,
                               sim.wheel.inertia_kgm2, words));
  }
}

/// Evidence of one record that is given twice would count twice.
void require_another_one(const Record& record, const std::string& name, const Record& other,
                         const std::string& others) {
  if (record.angle_rad != other.angle_rad) return;
  throw BadInput(
      fmt::format("{}: expected another record than {}, found the same angles; give each record once", name, others));
}

}  // namespace

gap::DiagnoseOptions DiagnosisRequest::options() const {
  gap::DiagnoseOptions options;
  options.seed = seed;
  options.without = without;
  options.figures = report;
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(time_limit_s);
  options.out_of_time = [end] { return Clock::now() >= end; };
  return options;
}

Json DiagnosisRequest::json() const {
  Json json = {{"columns", log.columns}, {"sign", log.sign}, {"seed", seed},
               {"without", without},     {"report", report}, {"time_limit_s", time_limit_s}};
  if (log.align) json["align"] = true;
  return json;
}

Json made_from(const DiagnosisFiles& files, const DiagnosisRequest& request) {
  Json from = {{"program", this_program()},
               {"options", request.json()},
               {"log", fingerprint(files.log)},
               {files.pred.empty() ? "sim" : "pred", fingerprint(files.simulated())}};
  for (const fs::path& file : files.further) from["further"].push_back(fingerprint(file));
  for (const fs::path& file : request.log.with) from["with"].push_back(fingerprint(file));
  for (const fs::path& file : request.log.dbc) from["dbc"].push_back(fingerprint(file));
  return from;
}

DiagnosisInputs read_inputs(const DiagnosisFiles& files, const DiagnosisRequest& request,
                            const gap::DiagnoseOptions& options) {
  DiagnosisInputs inputs;
  if (files.pred.empty()) inputs.sim = Simulation::load(files.sim);
  RecordQuality seen;
  Record read = request.log.read(files.log, &seen);
  const Record even = resample_100hz(read, files.log.string()).record;
  if (files.pred.empty()) require_units_of(inputs.sim, even, seen, files.log.string());
  take_notes(even, seen, files.further.empty() ? "" : printable(files.log.string()), inputs);
  inputs.own_torque = own_torque_words(even);
  inputs.record = with_driving_torques(std::move(read));
  if (!files.pred.empty()) understand_prediction(files, options, inputs);
  for (const fs::path& file : files.further) {
    RecordQuality of_it;
    Record one = read_log(file, request.log.format(), &of_it);
    const std::string name = printable(file.string());
    const Record at_100hz = resample_100hz(one, file.string()).record;
    if (files.pred.empty()) require_units_of(inputs.sim, at_100hz, of_it, name);
    take_notes(at_100hz, of_it, name, inputs);
    require_another_one(one, name, inputs.record, printable(files.log.string()));
    for (const gap::NamedRecord& other : inputs.further) require_another_one(one, name, other.record, other.name);
    inputs.further.push_back({name, with_driving_torques(std::move(one))});
  }
  return inputs;
}

DiagnosisOutcome diagnosis_of(const DiagnosisInputs& inputs, const DiagnosisFiles& files,
                              const gap::DiagnoseOptions& options) {
  DiagnosisOutcome out;
  gap::DiagnoseOptions beside = options;
  beside.not_credible = inputs.doubt;
  try {
    if (inputs.further.empty()) {
      if (inputs.predicted) beside.remainder = inputs.predicted->remainder;
      out.diagnosis = diagnose(inputs.record, inputs.sim, beside);
    } else {
      std::vector<gap::NamedRecord> records = {{printable(files.log.string()), inputs.record}};
      records.insert(records.end(), inputs.further.begin(), inputs.further.end());
      gap::Together together = diagnose_together(records, inputs.sim, beside);
      out.together = together_json(together, records);
      out.diagnosis = std::move(together.records.front());
    }
  } catch (const BadInput& error) {
    // What the columns cannot be says more than what no fit can make of them.
    std::string why = inputs.doubt.empty() ? error.what() : inputs.doubt;
    if (!inputs.further.empty()) throw BadInput(why);
    if (inputs.doubt.empty() && !inputs.own_torque.empty()) why += "; " + inputs.own_torque;
    throw BadInput(fmt::format("{}: {}", files.log.string(), why));
  }
  std::vector<std::string>& notes = out.diagnosis.notes;
  notes.insert(notes.begin(), inputs.notes.begin(), inputs.notes.end());
  if (out.diagnosis.verdict == "unknown" && !inputs.own_torque.empty()) notes.push_back(inputs.own_torque);
  return out;
}

Json answer_json(const gap::Diagnosis& diagnosis, const DiagnosisFiles& files, const DiagnosisRequest& request) {
  Json answer = diagnosis_json(diagnosis);
  answer["input"] = input_json(files.log);
  answer["options"] = request.json();
  answer["program"] = program_json();
  return answer;
}

Json write_diagnosis(const DiagnosisOutcome& outcome, const DiagnosisInputs& inputs, const DiagnosisFiles& files,
                     const DiagnosisRequest& request, const Json& made_from) {
  const gap::Diagnosis& diagnosis = outcome.diagnosis;
  Json answer = answer_json(diagnosis, files, request);
  answer.update(outcome.together);
  if (inputs.predicted) answer["prediction"] = prediction_json(*inputs.predicted);
  answer["made_from"] = made_from;
  if (request.report) {
    report::write_page(
        files.out / kReport,
        diagnosis_page({files.log.filename().string(), files.simulated().filename().string(), diagnosis, inputs.sim}));
  }
  write_whole_file(files.out / kSimulation, diagnosis.with_effect.to_json());
  write_whole_file(files.out / kAnswer, answer.dump(2) + "\n");
  return answer;
}

Json earlier_answer(const DiagnosisFiles& files, const DiagnosisRequest& request) {
  const fs::path answer = files.out / kAnswer;
  std::error_code none;
  const bool whole = fs::is_regular_file(answer, none) && fs::exists(files.out / kSimulation, none) &&
                     (!request.report || fs::exists(files.out / kReport, none));
  if (!whole) return nullptr;
  Json found;
  try {
    found = load_json<Json>(answer, "a diagnosis");
  } catch (const BadInput&) {
    return nullptr;  // damaged: it is made anew
  }
  // The files' sizes are told at once; to hash the files takes as long as to read them.
  const auto of_size = [&](const char* name, const fs::path& file) {
    const Json::json_pointer bytes(fmt::format("/made_from/{}/bytes", name));
    return found.contains(bytes) && found[bytes] == fs::file_size(file, none);
  };
  if (!found.is_object() || !of_size("log", files.log) || !of_size("sim", files.sim)) return nullptr;
  return found["made_from"] == made_from(files, request) && is_diagnosis(found) ? found : Json();
}

std::vector<fs::path> answer_files(const fs::path& out, const DiagnosisRequest& request) {
  std::vector<fs::path> files = {out / kAnswer, out / kSimulation};
  if (request.report) files.push_back(out / kReport);
  return files;
}

void remove_answer(const DiagnosisFiles& files) {
  std::error_code not_there;
  for (const char* name : {kAnswer, kSimulation, kReport}) fs::remove(files.out / name, not_there);
  fs::remove(files.out, not_there);
}

}  // namespace steerid
