// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fleet/record_facts.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace steerid::fleet {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::array kNumbers = {"inertia_kgm2", "damping_nms_per_rad", "stiffness_nm_per_rad"};

/// Null where there is no such field.
const Json& field(const Json& of, std::string_view name) {
  static const Json kNull;
  if (!of.is_object()) return kNull;
  const auto found = of.find(name);
  return found == of.end() ? kNull : *found;
}

double number(const Json& value) { return value.is_number() ? value.get<double>() : kNone; }

std::string text(const Json& value) { return value.is_string() ? value.get<std::string>() : std::string(); }

bool is_outcome(std::string_view id) { return id == "none" || id == "parameters" || id == "unknown"; }

void add_change(RecordFacts& facts, const Json& entry, const std::string& change, std::size_t entries) {
  const std::string effect = text(field(entry, "effect"));
  const double probability = number(field(entry, "probability"));
  if (effect.empty() || !(probability >= 0 && probability <= 1)) return;
  const double said = number(field(entry, "prior"));
  const double prior = said > 0 && said < 1 ? said : 1.0 / static_cast<double>(std::max<std::size_t>(2, entries));
  facts.changes.push_back({effect, change, probability, prior});
}

void add_changes(RecordFacts& facts, const Json& answer) {
  const Json& inclusion = field(answer, "inclusion");
  const Json& ranking = field(answer, "ranking");
  const bool by_inclusion = inclusion.is_array() && !inclusion.empty();
  if (by_inclusion) {
    for (const Json& one : inclusion) {
      const std::string change = text(field(one, "change"));
      add_change(facts, one, change.empty() ? "add" : change, inclusion.size());
    }
  }
  if (!ranking.is_array()) return;
  for (const Json& one : ranking) {
    const bool outcome = is_outcome(text(field(one, "effect")));
    if (outcome || !by_inclusion) add_change(facts, one, outcome ? "" : "add", ranking.size());
  }
}

PlaceFact place(const Json& where) {
  PlaceFact out{.axis = text(field(where, "axis")), .unit = text(field(where, "unit"))};
  const Json& range = field(where, "range");
  if (range.is_array() && range.size() == 2) {
    out.low = number(range[0]);
    out.high = number(range[1]);
  }
  if (!std::isfinite(out.low) || !std::isfinite(out.high)) out.axis.clear();
  return out;
}

void add_number(RecordFacts& facts, std::string name, const Json& value) {
  if (const double one = number(value); std::isfinite(one)) facts.quantities.push_back({std::move(name), one});
}

}  // namespace

RecordFacts facts_of_diagnosis(const Json& answer) {
  RecordFacts out;
  add_changes(out, answer);
  out.closed = number(field(field(answer, "gap"), "closed_fraction"));
  out.unknown = text(field(answer, "verdict")) == "unknown";
  if (out.unknown) {
    out.unexplained = place(field(field(answer, "unexplained"), "where"));
    if (out.unexplained.axis.empty()) out.unexplained = place(field(answer, "where"));
  }
  for (const char* name : kNumbers) add_number(out, name, field(field(field(answer, "base"), name), "value"));
  if (field(answer, "surrogate") == true) return out;
  const Json& causes = field(answer, "causes");
  if (!causes.is_array()) return out;
  for (const Json& cause : causes) {
    const Json& parameters = field(cause, "parameters");
    if (!parameters.is_object()) continue;
    for (const auto& [name, value] : parameters.items()) {
      add_number(out, text(field(cause, "effect")) + " " + name, value);
    }
  }
  return out;
}

RecordFacts facts_of_identification(const Json& answer) {
  RecordFacts out;
  out.closed = kNone;
  out.doubt = text(field(answer, "doubt"));
  const Json& batch = field(answer, "batch");
  for (const char* name : kNumbers) {
    const Json& recursive = field(answer, name);
    if (text(field(recursive, "state")) == "valid") add_number(out, name, field(recursive, "value"));
    if (batch.is_object() && text(field(field(batch, name), "state")) == "valid") {
      add_number(out, std::string("batch ") + name, field(field(batch, name), "value"));
    }
  }
  add_number(out, "free_run_nrmse", field(answer, "free_run_nrmse"));
  return out;
}

}  // namespace steerid::fleet
