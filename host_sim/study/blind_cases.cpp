// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/blind_cases.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "log/bad_input.hpp"
#include "plant/json_text.hpp"

namespace steerid::blind_study {
namespace {

using Json = nlohmann::json;

/// JSON has no infinity; what is unbounded stands there as null.
double end(const Json& json, double unbounded) { return json.is_number() ? json.get<double>() : unbounded; }

Interval interval(const Json& json) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {end(json.at(0), -kInfinity), end(json.at(1), kInfinity)};
}

double number(const Json& json) { return json.is_number() ? json.get<double>() : std::nan(""); }

Truth truth(const Json& json) {
  Truth out;
  out.label = json.at("label");
  out.effects = json.at("effects");
  out.gap_over_floor = json.at("ratio");
  for (const auto& [effect, values] : json.at("parameters").items()) {
    for (const auto& [name, value] : values.items()) out.parameters[effect][name] = value;
  }
  out.several_case = json.value("case", "");
  for (const Json& one : json.value("changes", Json::array())) out.changes.emplace(one.at("effect"), one.at("change"));
  for (const auto& [name, value] : json.at("plant").at("arm").items()) out.arm[name] = value;
  return out;
}

NamedCause cause(const Json& json) {
  NamedCause out;
  out.effect = json.at("effect");
  out.change = json.value("change", "add");
  const Json intervals = json.value("ci95", Json::object());
  for (const auto& [name, value] : json.at("parameters").items()) {
    if (!value.is_number()) continue;
    Estimated& estimated = out.parameters[name];
    estimated = {number(value), {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}};
    if (intervals.contains(name)) estimated.ci95 = interval(intervals.at(name));
  }
  return out;
}

Answer answer(const Json& json) {
  Answer out;
  out.verdict = json.at("verdict");
  out.equivalent = json.at("equivalent");
  for (const Json& ranked : json.at("ranking")) out.probability[ranked.at("effect")] = ranked.at("probability");
  for (const Json& one : json.at("causes")) out.causes.push_back(cause(one));
  for (const Json& one : json.value("inclusion", Json::array())) {
    out.inclusion[{one.at("effect"), one.at("change")}] = one.at("probability");
  }
  const Json& gap = json.at("gap");
  if (gap.at("closed_fraction").is_number()) {
    out.closed_fraction = Estimated{gap.at("closed_fraction"), interval(gap.at("closed_fraction_ci95"))};
  }
  for (const auto& [name, value] : json.at("base").items()) {
    out.arm[name] = {number(value.at("value")), interval(value.at("ci95"))};
  }
  return out;
}

}  // namespace

std::set<Change> Answer::changes() const {
  std::set<Change> out;
  if (verdict == "unknown") return out;
  for (const NamedCause& one : causes) out.emplace(one.effect, one.change);
  return out;
}

std::map<std::string, Truth> read_key(std::string_view text, const std::string& file) {
  std::map<std::string, Truth> out;
  try {
    const Json json = parse_json(text, file);
    for (const auto& [name, one] : json.items()) out[name] = truth(one);
  } catch (const Json::exception& error) {
    throw bad_input({.file = file, .expected = "the key of a blind study", .found = error.what()});
  }
  return out;
}

std::optional<Answer> read_answer(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  try {
    return answer(load_json(file, "a diagnosis"));
  } catch (const Json::exception& error) {
    throw bad_input({.file = file.string(), .expected = "a diagnosis", .found = error.what()});
  }
}

}  // namespace steerid::blind_study
