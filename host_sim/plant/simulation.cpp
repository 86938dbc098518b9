// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "plant/simulation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "log/bad_input.hpp"
#include "plant/json_text.hpp"
#include "plant/plant.hpp"

namespace steerid {
namespace {

using nlohmann::json;

constexpr std::string_view kBandLimited = "band_limited";
constexpr std::string_view kHeld = "held";

/// A value and where it stands.
struct Place {
  std::string_view file;
  std::string pointer;
  const json& value;

  [[nodiscard]] Place operator[](const std::string& key) const { return {file, pointer + "/" + key, value.at(key)}; }
  [[nodiscard]] Place operator[](std::size_t index) const {
    return {file, fmt::format("{}/{}", pointer, index), value.at(index)};
  }
  [[nodiscard]] std::string at() const { return pointer.empty() ? std::string("top level") : pointer; }

  [[noreturn]] void complain(std::string_view expected, std::string_view advice) const {
    throw BadInput(
        fmt::format("{}, at {}: expected {}, found {}; {}", file, at(), expected, in_quotes(value.dump()), advice));
  }

  void require_object(std::string_view advice) const {
    if (!value.is_object()) complain("an object", advice);
  }
  void allow_only(std::span<const std::string_view> keys) const {
    for (const auto& [key, unused] : value.items()) {
      if (std::ranges::find(keys, key) != keys.end()) continue;
      throw BadInput(fmt::format("{}, at {}: expected one of {}, found the key {}; check its spelling", file, at(),
                                 fmt::join(keys, ", "), in_quotes(key)));
    }
  }
  [[nodiscard]] double number(double low, double high, bool whole, std::string_view advice) const {
    const double given = value.is_number() ? value.get<double>() : std::nan("");
    const bool fits = given >= low && given <= high && (!whole || given == std::floor(given));
    if (!fits) complain(fmt::format("a {}number from {} to {}", whole ? "whole " : "", low, high), advice);
    return given;
  }
};

double wheel_number(const Place& top, const std::string& key, double low, std::string_view symbol) {
  constexpr double kLargest = 1e9;  // a linear drive in place of a wheel has kilograms and newtons here
  if (!top.value.contains(key)) {
    throw BadInput(fmt::format("{}, at {}: expected the key {}, found none; give {} in the unit of its name", top.file,
                               top.at(), key, symbol));
  }
  return top[key].number(low, kLargest, false, fmt::format("{} cannot be otherwise", symbol));
}

std::string names(std::span<const Parameter> parameters) {
  std::vector<std::string_view> all;
  for (const Parameter& parameter : parameters) all.push_back(parameter.name);
  return fmt::format("{}", fmt::join(all, ", "));
}

const EffectType& effect_type(const Place& id) {
  if (!id.value.is_string()) id.complain("the id of an effect", "quote it");
  try {
    return find_effect(id.value.get<std::string>());
  } catch (const BadInput& error) {
    throw BadInput(fmt::format("{}, at {}: {}", id.file, id.at(), error.what()));
  }
}

void read_parameters(const Place& place, Effect& effect) {
  place.require_object("give name and value of each parameter");
  const auto parameters = effect.type->parameters;
  for (const auto& [name, unused] : place.value.items()) {
    const auto found = std::ranges::find(parameters, name, &Parameter::name);
    if (found == parameters.end()) {
      throw BadInput(fmt::format("{}, at {}: expected one of {}, found the key {}; check its spelling", place.file,
                                 place.at(), names(parameters), in_quotes(name)));
    }
    effect.values[static_cast<std::size_t>(found - parameters.begin())] = place[name].number(
        found->low, found->high, found->whole, fmt::format("it is {} of {}", found->says, effect.type->id));
  }
}

Effect read_effect(const Place& place) {
  place.require_object(R"(write {"effect": ID, "parameters": {...}})");
  constexpr std::array<std::string_view, 3> kKeys = {"effect", "parameters", "time_course_nm"};
  if (!place.value.contains("effect")) place.complain("the key effect", "name the effect by its id");
  Effect effect(effect_type(place["effect"]));
  place.allow_only(std::span(kKeys).first(effect.type->takes_time_course ? 3 : 2));
  if (place.value.contains("parameters")) read_parameters(place["parameters"], effect);
  if (place.value.contains("time_course_nm")) {
    const Place course = place["time_course_nm"];
    if (!course.value.is_array()) course.complain("a list of numbers", "give one coefficient a knot");
    for (std::size_t i = 0; i < course.value.size(); ++i) {
      effect.time_course_nm.push_back(course[i].number(-1e3, 1e3, false, "it is a torque in Nm"));
    }
  }
  return effect;
}

void read_effects(const Place& place, std::vector<Effect>& effects) {
  if (!place.value.is_array()) place.complain("a list of effects", R"(write [{"effect": ID, "parameters": {...}}])");
  for (std::size_t i = 0; i < place.value.size(); ++i) effects.push_back(read_effect(place[i]));
  try {
    check_compatible(effects);
  } catch (const BadInput& error) {
    throw BadInput(fmt::format("{}, at {}: {}", place.file, place.at(), error.what()));
  }
}

}  // namespace

Simulation Simulation::from_json(std::string_view text, std::string_view name) {
  const json document = parse_json(text, name);
  const Place top{name, "", document};
  top.require_object("see the simulation's JSON in the documentation");
  constexpr std::array<std::string_view, 6> kKeys = {"inertia_kgm2", "damping_nms_per_rad",    "stiffness_nm_per_rad",
                                                     "effects",      "torque_between_samples", "sensors"};
  top.allow_only(kKeys);
  Simulation simulation;
  simulation.wheel.inertia_kgm2 = wheel_number(top, "inertia_kgm2", 1e-9, "the inertia");
  simulation.wheel.damping_nms_per_rad = wheel_number(top, "damping_nms_per_rad", 0, "the damping");
  simulation.wheel.stiffness_nm_per_rad = wheel_number(top, "stiffness_nm_per_rad", 0, "the stiffness");
  if (document.contains("effects")) read_effects(top["effects"], simulation.effects);
  if (document.contains("torque_between_samples")) {
    const Place between = top["torque_between_samples"];
    const bool held = between.value == kHeld;
    if (!held && between.value != kBandLimited) {
      between.complain("band_limited or held", "held is for an EPS that holds its target between samples");
    }
    simulation.torque_between_samples = held ? TorqueSignal::Between::kHeld : TorqueSignal::Between::kBandLimited;
  }
  if (document.contains("sensors")) {
    top["sensors"].require_object("leave the key out for the usual sensors");
    simulation.sensors_json = document["sensors"].dump();
  }
  simulation.check_cost(name);
  return simulation;
}

void Simulation::check_cost(std::string_view name) const {
  double steps_per_s = 0;
  try {
    steps_per_s = Plant(effects, {.wheel = wheel}).most_steps_per_s();
  } catch (const std::length_error& error) {
    throw BadInput(
        fmt::format("{}: expected effects that can act together, found {}; leave some out", name, error.what()));
  }
  if (steps_per_s <= kMostStepsPerS) return;
  throw BadInput(
      fmt::format("{}: expected a wheel that can be followed in {:g} steps a second, found one that takes {:.2g}: its "
                  "stiffness or damping is too large beside its inertia, or an effect too fast; check their units",
                  name, kMostStepsPerS, steps_per_s));
}

Simulation Simulation::load(const std::filesystem::path& file) {
  return from_json(read_whole_file(file, "a simulation in JSON"), file.string());
}

std::string Simulation::to_json() const {
  nlohmann::ordered_json document;
  document["inertia_kgm2"] = wheel.inertia_kgm2;
  document["damping_nms_per_rad"] = wheel.damping_nms_per_rad;
  document["stiffness_nm_per_rad"] = wheel.stiffness_nm_per_rad;
  document["effects"] = nlohmann::ordered_json::array();
  for (const Effect& effect : effects) {
    nlohmann::ordered_json entry;
    entry["effect"] = effect.type->id;
    entry["parameters"] = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < effect.values.size(); ++i) {
      entry["parameters"][std::string(effect.type->parameters[i].name)] = effect.values[i];
    }
    if (!effect.time_course_nm.empty()) entry["time_course_nm"] = effect.time_course_nm;
    document["effects"].push_back(entry);
  }
  document["torque_between_samples"] = torque_between_samples == TorqueSignal::Between::kHeld ? kHeld : kBandLimited;
  if (!sensors_json.empty()) document["sensors"] = nlohmann::ordered_json::parse(sensors_json);
  return document.dump(2) + "\n";
}

std::vector<double> free_run(const Simulation& simulation, const Record& record,
                             const std::optional<WheelState>& initial) {
  FreeRun run(record, {.between = simulation.torque_between_samples});
  const auto angle = run(simulation.wheel, simulation.effects, initial);
  return {angle.begin(), angle.end()};
}

}  // namespace steerid
