#include "apps/diagnosis_request.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <utility>

#include "apps/diagnosis_page.hpp"
#include "apps/sealed_key.hpp"
#include "gap/diagnosis/diagnosis_json.hpp"
#include "log/bad_input.hpp"
#include "log/log_reader.hpp"
#include "log/output_folder.hpp"
#include "log/whole_file.hpp"
#include "report/page.hpp"

namespace steerid {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* kAnswer = "diagnosis.json";
constexpr const char* kSimulation = "sim_with_effect.json";
constexpr const char* kReport = "report.html";

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || fs::is_directory(file)) {
    throw bad_input({.file = file.string(),
                     .expected = "a readable file",
                     .found = "none",
                     .advice = "check path and permissions"});
  }
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return std::move(bytes).str();
}

Json fingerprint(const fs::path& file) {
  const std::string bytes = bytes_of(file);
  return {{"bytes", bytes.size()}, {"sha256", sha256(bytes)}};
}

/// A version's number stays while its code is worked on; the program's own bytes do not.
const std::string& this_program() {
  static const std::string kHash = sha256(bytes_of("/proc/self/exe"));
  return kHash;
}

}  // namespace

LogFormat DiagnosisRequest::format() const {
  LogFormat format;
  if (!columns.empty()) format.columns = parse_columns(columns);
  if (!sign.empty()) format.reversed = parse_sign(sign);
  return format;
}

DiagnoseOptions DiagnosisRequest::options() const {
  DiagnoseOptions options;
  options.seed = seed;
  options.without = without;
  options.figures = report;
  return options;
}

Json made_from(const DiagnosisFiles& files, const DiagnosisRequest& request) {
  return {{"program", this_program()},
          {"options",
           {{"columns", request.columns},
            {"sign", request.sign},
            {"seed", request.seed},
            {"without", request.without},
            {"report", request.report}}},
          {"log", fingerprint(files.log)},
          {"sim", fingerprint(files.sim)}};
}

DiagnosisInputs read_inputs(const DiagnosisFiles& files, const DiagnosisRequest& request) {
  DiagnosisInputs inputs;
  inputs.sim = Simulation::load(files.sim);
  RecordQuality seen;
  inputs.record = read_log(files.log, request.format(), &seen);
  inputs.notes = seen.notes;
  return inputs;
}

Diagnosis diagnosis_of(const DiagnosisInputs& inputs, const DiagnosisFiles& files, const DiagnoseOptions& options) {
  Diagnosis diagnosis;
  try {
    diagnosis = diagnose(inputs.record, inputs.sim, options);
  } catch (const BadInput& error) {
    throw BadInput(fmt::format("{}: {}", files.log.string(), error.what()));
  }
  diagnosis.notes.insert(diagnosis.notes.begin(), inputs.notes.begin(), inputs.notes.end());
  return diagnosis;
}

Json write_diagnosis(const Diagnosis& diagnosis, const DiagnosisInputs& inputs, const DiagnosisFiles& files,
                     const DiagnosisRequest& request, const Json& made_from) {
  Json answer = diagnosis_json(diagnosis);
  answer["made_from"] = made_from;
  if (request.report) {
    report::write_page(files.out / kReport, diagnosis_page({files.log.filename().string(),
                                                            files.sim.filename().string(), diagnosis, inputs.sim}));
  }
  write_whole_file(files.out / kSimulation, diagnosis.with_effect.to_json());
  write_whole_file(files.out / kAnswer, answer.dump(2) + "\n");
  return answer;
}

Json earlier_answer(const DiagnosisFiles& files, const DiagnosisRequest& request, const Json& made_from) {
  std::ifstream stream(files.out / kAnswer);
  if (!stream) return nullptr;
  Json found = Json::parse(stream, nullptr, false);
  const bool same = found.is_object() && found.value("made_from", Json()) == made_from;
  const bool whole = fs::exists(files.out / kSimulation) && (!request.report || fs::exists(files.out / kReport));
  return same && whole ? found : Json();
}

void remove_answer(const DiagnosisFiles& files) {
  std::error_code not_there;
  for (const char* name : {kAnswer, kSimulation, kReport}) fs::remove(files.out / name, not_there);
  fs::remove(files.out, not_there);
}

}  // namespace steerid
