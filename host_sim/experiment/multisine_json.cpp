#include "experiment/multisine_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
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
                    file, key, low, high, found == probe.end() ? "none" : found->dump()));
  }
  return value;
}

}  // namespace

PlannedProbe load_probe(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::ifstream stream(file);
  if (!stream) throw BadInput(fmt::format("{}: expected a readable file; check its name and permissions", name));
  std::ostringstream text;
  text << stream.rdbuf();
  nlohmann::json json = parse_json(text.str(), name);
  if (!json.is_object()) throw BadInput(fmt::format("{}: expected JSON with a probe, an object in braces", name));
  if (json.contains("next_experiment")) json = nlohmann::json(json["next_experiment"]).value("probe", nlohmann::json());
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
