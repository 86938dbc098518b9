// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "plant/column.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "log/bad_input.hpp"
#include "plant/json_text.hpp"

namespace steerid {
namespace {

using Json = nlohmann::ordered_json;

struct Field {
  std::string_view key;
  double Column::*value;
  double low;
  double high;
};

constexpr std::array<Field, 16> kFields = {{
    {"wheel_inertia_kgm2", &Column::wheel_inertia_kgm2, 0.001, 1},
    {"wheel_damping_nms_per_rad", &Column::wheel_damping_nms_per_rad, 0, 10},
    {"wheel_friction_nm", &Column::wheel_friction_nm, 0, 20},
    {"bar_stiffness_nm_per_rad", &Column::bar_stiffness_nm_per_rad, 10, 1e4},
    {"bar_damping_nms_per_rad", &Column::bar_damping_nms_per_rad, 0, 10},
    {"column_inertia_kgm2", &Column::column_inertia_kgm2, 0.005, 10},
    {"column_damping_nms_per_rad", &Column::column_damping_nms_per_rad, 0, 100},
    {"aligning_stiffness_nm_per_rad", &Column::aligning_stiffness_nm_per_rad, 0, 1e3},
    {"rack_friction_nm", &Column::rack_friction_nm, 0, 20},
    {"assist_gain", &Column::assist_gain, 0, 20},
    {"assist_dead_zone_nm", &Column::assist_dead_zone_nm, 0, 10},
    {"motor_limit_nm", &Column::motor_limit_nm, 0.1, 1e3},
    {"probe_gain", &Column::probe_gain, 0, 10},
    {"probe_delay_s", &Column::probe_delay_s, 0, Column::kLongestProbeDelayS},
    {"road_rms_nm", &Column::road_rms_nm, 0, 20},
    {"road_corner_hz", &Column::road_corner_hz, 0.01, 15},
}};

constexpr std::string_view kSensors = "sensors";

std::string known_keys() {
  std::string all;
  for (const Field& field : kFields) all += fmt::format("{}, ", field.key);
  return all.append(kSensors);
}

}  // namespace

Column Column::from_json(std::string_view text, std::string_view name) {
  const nlohmann::json document = parse_json(text, name);
  if (!document.is_object()) {
    throw BadInput(fmt::format("{}: expected an object of the column's numbers, found {}; write {{...}}", name,
                               in_quotes(document.dump())));
  }
  Column column;
  for (const auto& [key, value] : document.items()) {
    if (key == kSensors) {
      column.sensors_json = value.dump();
      continue;
    }
    const auto field = std::find_if(kFields.begin(), kFields.end(), [&](const Field& one) { return one.key == key; });
    if (field == kFields.end()) {
      throw BadInput(fmt::format("{}: expected one of {}, found the key {}; check its spelling", name, known_keys(),
                                 in_quotes(key)));
    }
    const double number = value.is_number() ? value.get<double>() : std::nan("");
    if (!(number >= field->low && number <= field->high)) {
      throw BadInput(fmt::format("{}, at /{}: expected a number from {} to {}, found {}; leave the key out for {}",
                                 name, key, field->low, field->high, in_quotes(value.dump()), Column{}.*field->value));
    }
    column.*field->value = number;
  }
  return column;
}

Column Column::load(const std::filesystem::path& file) {
  return from_json(read_whole_file(file, "a column in JSON"), file.string());
}

std::string Column::to_json() const {
  Json json;
  for (const Field& field : kFields) json[std::string(field.key)] = this->*field.value;
  if (!sensors_json.empty()) json[std::string(kSensors)] = Json::parse(sensors_json);
  return json.dump(2) + "\n";
}

std::string Column::commented() {
  std::string text =
      "// A steering column, for `steerid simulate --task drive --column`. Lines that begin with // are comments. A "
      "number "
      "that\n"
      "// is left out has the value shown; after each its range. \"sensors\" is as in a simulation's file, with "
      "torque_bar,\n"
      "// torque_rim and probe in place of torque_driver.\n"
      "{\n";
  for (const Field& field : kFields) {
    const bool last = &field == &kFields.back();
    text += fmt::format("  \"{}\": {}{}  // {} to {}\n", field.key, Column{}.*field.value, last ? "" : ",", field.low,
                        field.high);
  }
  return text + "}\n";
}

}  // namespace steerid
