// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fleet/answer_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "log/bad_input.hpp"

namespace steerid::fleet {
namespace {

using Json = nlohmann::ordered_json;

std::string number(const Json& value) {
  return value.is_number() ? fmt::format("{:.6g}", value.get<double>()) : std::string();
}

std::vector<std::string> diagnosis_cells(const Json& diagnosis) {
  const Json& gap = diagnosis.at("gap");
  return {diagnosis.at("verdict").get<std::string>(),
          number(diagnosis.value("probability", diagnosis.at("ranking").at(0).at("probability"))),
          number(gap.at("sim_nrmse")),
          number(gap.at("refit_nrmse")),
          number(gap.at("with_effect_nrmse")),
          number(gap.at("floor_nrmse")),
          number(gap.at("closed_fraction"))};
}

std::vector<std::string> identification_cells(const Json& found) {
  std::vector<std::string> cells;
  for (const char* name : {"inertia_kgm2", "damping_nms_per_rad", "stiffness_nm_per_rad"}) {
    const Json& parameter = found.at(name);
    cells.insert(cells.end(),
                 {number(parameter.at("value")), number(parameter.at("sd")), parameter.at("state").get<std::string>()});
  }
  cells.push_back(number(found.at("free_run_nrmse")));
  cells.push_back(found.value("doubt", ""));
  return cells;
}

const std::array<AnswerKind, 2>& kinds() {
  static const std::array<AnswerKind, 2> kAll = {
      AnswerKind{"diagnose",
                 {"case", "verdict", "probability", "sim_nrmse", "refit_nrmse", "with_effect_nrmse", "floor_nrmse",
                  "closed_fraction", "error"},
                 {"verdict", "probability", "ranking", "inclusion", "causes", "surrogate", "equivalent", "where",
                  "unexplained", "gap", "base"},
                 diagnosis_cells,
                 facts_of_diagnosis},
      AnswerKind{"identify",
                 {"case", "inertia_kgm2", "inertia_sd_kgm2", "inertia_state", "damping_nms_per_rad",
                  "damping_sd_nms_per_rad", "damping_state", "stiffness_nm_per_rad", "stiffness_sd_nm_per_rad",
                  "stiffness_state", "free_run_nrmse", "doubt", "error"},
                 {"method", "inertia_kgm2", "damping_nms_per_rad", "stiffness_nm_per_rad", "natural_frequency_hz",
                  "damping_ratio", "free_run_nrmse", "doubt", "batch"},
                 identification_cells,
                 facts_of_identification}};
  return kAll;
}

}  // namespace

const AnswerKind& kind_of(std::string_view command) {
  for (const AnswerKind& kind : kinds()) {
    if (kind.command == command) return kind;
  }
  throw BadInput(
      fmt::format("there is no fleet of {} answers; diagnose and identify have one", in_quotes(std::string(command))));
}

Json digest(const AnswerKind& kind, const Json& answer) {
  Json out = Json::object();
  for (const std::string_view field : kind.kept) {
    if (const auto found = answer.find(field); found != answer.end()) out[std::string(field)] = *found;
  }
  return out;
}

AnswerTable::AnswerTable(const AnswerKind& kind, const std::filesystem::path& target)
    : kind_(kind), csv_(target, kind.columns) {}

void AnswerTable::add(const RecordLine& line) {
  csv_.cell(line.record.name);
  if (line.answer.is_null()) {
    for (std::size_t i = 2; i < kind_.columns.size(); ++i) csv_.cell("");
  } else {
    for (const std::string& cell : kind_.cells(line.answer)) csv_.cell(cell);
  }
  csv_.cell(line.error).end_row();
}

bool is_answer_table(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string first;
  if (!std::getline(in, first)) return false;
  return std::ranges::any_of(
      kinds(), [&](const AnswerKind& kind) { return first == fmt::format("{}", fmt::join(kind.columns, ",")); });
}

}  // namespace steerid::fleet
