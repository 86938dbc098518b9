// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "experiment/multisine_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "log/bad_input.hpp"
#include "plant/json_text.hpp"

namespace steerid {
namespace {

double number_in(const nlohmann::json& probe, const char* key, double low, double high, const std::string& file) {
  const auto found = probe.find(key);
  const double value = found != probe.end() && found->is_number() ? found->get<double>() : std::nan("");
  if (!(value >= low && value <= high)) {
    throw BadInput(
        fmt::format("{}: expected a probe whose {} is a number from {:g} to {:g}, found {}; see "
                    "next_experiment in a diagnosis.json",
                    file, key, low, high, found == probe.end() ? "none" : in_quotes(found->dump())));
  }
  return value;
}

/// The probe itself, or what a diagnosis proposes.
const nlohmann::json& probe_in(const nlohmann::json& document, const std::string& file) {
  const nlohmann::json* probe = &document;
  for (const char* key : {"next_experiment", "probe"}) {
    if (probe->is_object() && probe->contains(key)) probe = &(*probe)[key];
  }
  if (probe->is_object()) return *probe;
  throw BadInput(fmt::format("{}: expected a probe or a next_experiment that holds one, an object in braces, found {}",
                             file, in_quotes(probe->dump())));
}

}  // namespace

PlannedProbe load_probe(const std::filesystem::path& file) {
  const std::string name = file.string();
  const nlohmann::json document = load_json(file, "a probe in JSON");
  const nlohmann::json& json = probe_in(document, name);
  PlannedProbe planned;
  planned.multisine.rms_nm = number_in(json, "rms_nm", 0, 20, name);
  planned.multisine.low_hz = number_in(json, "low_hz", 0.01, 20, name);
  planned.multisine.high_hz = number_in(json, "high_hz", planned.multisine.low_hz, 20, name);
  planned.multisine.period_s = number_in(json, "period_s", 0.1, 1000, name);
  planned.duration_s = number_in(json, "duration_s", 1, 86'400, name);
  try {
    (void)Multisine(planned.multisine);
  } catch (const std::invalid_argument& error) {
    throw BadInput(fmt::format("{}: expected a probe that can be played: {}", name, error.what()));
  }
  return planned;
}

}  // namespace steerid
