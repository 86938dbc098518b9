// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/identify_folder.hpp"

#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>
#include <vector>

#include "apps/made_from.hpp"
#include "fleet/answer_table.hpp"
#include "log/bad_input.hpp"
#include "log/output_folder.hpp"
#include "log/whole_file.hpp"
#include "plant/json_text.hpp"

namespace steerid {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kAnswer = "identification.json";
constexpr const char* kReport = "report.html";

void remove_identification(const fs::path& out) {
  std::error_code not_there;
  for (const char* name : {kAnswer, kReport}) fs::remove(out / name, not_there);
  fs::remove(out, not_there);
}

std::vector<fs::path> identification_files(const fs::path& out, bool report) {
  std::vector<fs::path> files = {out / kAnswer};
  if (report) files.push_back(out / kReport);
  return files;
}

/// What identification.json says when it was made from `made_from`, is whole, and its page is there; null otherwise.
Json earlier_identification(const fs::path& out, bool report, const Json& made_from) {
  std::error_code none;
  for (const fs::path& file : identification_files(out, report)) {
    if (!fs::is_regular_file(file, none)) return nullptr;
  }
  try {
    const Json found = load_json<Json>(out / kAnswer, "an identification");
    (void)fleet::kind_of("identify").cells(found);
    return found.at("made_from") == made_from ? found : Json();
  } catch (const BadInput&) {
    return nullptr;  // damaged: it is made anew
  } catch (const Json::exception&) {
    return nullptr;
  }
}

Json identification(const fs::path& log, const fs::path& out, const IdentifyRequest& request, bool report,
                    const Json& made_from) {
  remove_identification(out);  // to another question: if there is none to this one, it would pass for it
  const IdentifiedLog found = identify_log(read_log(log, request), request);
  make_output_folder(out);
  Json answer = found.json();
  answer["made_from"] = made_from;
  if (report) write_identify_page(out / kReport, log.filename().string(), found);
  write_whole_file(out / kAnswer, answer.dump(2) + "\n");  // last: where it stands the page does
  return answer;
}

}  // namespace

void identify_folder(const BatchPlace& place, const IdentifyRequest& request, bool report, FilesOfRun& files) {
  (void)request.log.format();  // an option that cannot be read is no record's fault
  Json options = request.json();
  options["report"] = report;
  const auto answer = [&](const fleet::ListedRecord& record, const fs::path& out) {
    const fs::path log = place.folder / record.log;
    Json from = {{"log", fingerprint(log)}};
    const Json made_from = {{"program", this_program()}, {"options", options}, {"log", from.at("log")}};
    Json found = earlier_identification(out, report, made_from);
    const bool kept = !found.is_null();
    if (!kept) found = identification(log, out, request, report, made_from);
    return RecordAnswer{.made_from = std::move(from), .answer = std::move(found), .kept = kept};
  };
  run_batch({.command = "identify",
             .options = options,
             .label = "identifying",
             .answer = answer,
             .inputs = [&](const fleet::ListedRecord& record) { return std::vector{place.folder / record.log}; },
             .outputs = [&](const fs::path& out) { return identification_files(out, report); },
             .remove = remove_identification},
            place, files);
}

}  // namespace steerid
