// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/own_arm.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "apps/identification_json.hpp"
#include "apps/identification_table.hpp"
#include "log/bad_input.hpp"
#include "plant/json_text.hpp"

namespace steerid {
namespace {

using Json = nlohmann::json;

constexpr const char* kWheelFile = "the answer of `steerid identify --batch --json` to a record with the hands off";

/// {"value":, "sd":} as identification_json() writes it; nothing where it is something else.
std::optional<FittedNumber> number_in(const Json& stated) {
  const Json value = stated.is_object() ? stated.value("value", Json()) : Json();
  const Json sd = stated.is_object() ? stated.value("sd", Json()) : Json();
  if (!value.is_number() || !sd.is_number()) return std::nullopt;
  return FittedNumber{value.get<double>(), sd.get<double>()};
}

/// J, B or C of the wheel.
FittedNumber wheel_number(const Json& answer, const char* key, const std::string& file, bool has_to_be_valid = true) {
  const Json parameter = answer.value(key, Json::object());
  const std::optional<FittedNumber> number = number_in(parameter);
  const std::string state = parameter.is_object() && parameter.contains("state") ? parameter["state"].dump() : "none";
  if (!number || (has_to_be_valid && state != "\"valid\"")) {
    throw bad_input({.file = file,
                     .expected = fmt::format("{} of a wheel alone, valid, with its sd", key),
                     .found = state == "none" ? std::string("none") : "one in the state " + state,
                     .advice = fmt::format("give {}; a probe moves the wheel as it has to", kWheelFile)});
  }
  return *number;
}

/// The wheel's dry friction.
FittedNumber friction_of(const Json& stated, const std::string& file) {
  const std::optional<FittedNumber> friction = number_in(stated);
  if (!friction || !(friction->value >= 0)) {
    throw bad_input({.file = file,
                     .expected = "friction_nm of a wheel alone with its sd, 0 or more",
                     .found = stated.dump(),
                     .advice = fmt::format("give {}", kWheelFile)});
  }
  return *friction;
}

IdentifiedParameter less(const IdentifiedParameter& sum, const FittedNumber& wheel) {
  constexpr double kValidRelativeSd = 0.25;
  IdentifiedParameter own = sum;
  own.at_most.reset();
  own.value -= wheel.value;
  own.sd = std::hypot(sum.sd, wheel.sd);
  if (is_identified(own.state) && !(own.sd <= kValidRelativeSd * own.value)) own.state = ParameterState::kNotExcited;
  return own;
}

/// `stated` is the equation of the wheel's answer; an answer that states none is taken at its word.
void require_wheel(bool above_bar, const Json& stated, const std::string& file) {
  if (!stated.is_string() || (stated != name(Equation::kDriverMotor)) == above_bar) return;
  throw bad_input({.file = file,
                   .expected = above_bar ? "the wheel above the torsion bar, as the record has its torque"
                                         : "wheel and column, as the record has the motor's torque",
                   .found = fmt::format("the equation {}", stated.get<std::string>()),
                   .advice = "record with the hands off by the same channels"});
}

/// Why `answer` is not credible; empty where it is, or does not say.
std::string doubt_of(const Json& answer) {
  if (answer.value("credible", Json()) != false) return "";
  std::string doubt = "it is not credible";
  for (const Json& reason : answer.value("reasons", Json::array())) {
    if (reason.is_string()) doubt += fmt::format("; {}", reason.get<std::string>());
  }
  return doubt;
}

}  // namespace

WheelAlone load_wheel(const std::filesystem::path& file, Equation equation) {
  const Json whole = load_json(file, kWheelFile);
  const Json answer = whole.is_object() ? whole.value("batch", whole) : Json();
  if (!answer.is_object()) throw bad_input({.file = file.string(), .expected = kWheelFile, .found = "something else"});
  const bool above_bar = equation != Equation::kDriverMotor;
  require_wheel(above_bar, whole.value("equation", Json()), file.string());
  // Beside dry friction little is left to be damping: its deviation says how little is known.
  const bool dry = answer.contains("friction_nm");
  WheelAlone wheel{wheel_number(answer, "inertia_kgm2", file.string()),
                   wheel_number(answer, "damping_nms_per_rad", file.string(), !dry), printable(file.string())};
  const Json stiffness = answer.value("stiffness_nm_per_rad", Json::object());
  if (stiffness.is_object() && stiffness.value("state", Json()) == "valid") {
    wheel.stiffness = wheel_number(answer, "stiffness_nm_per_rad", file.string());
    if (above_bar) {
      throw bad_input({.file = file.string(),
                       .expected = "a wheel alone, which has no stiffness above the torsion bar",
                       .found = fmt::format("{:.3g} Nm/rad", wheel.stiffness.value),
                       .advice = "record with the hands off"});
    }
  }
  if (above_bar && dry) wheel.friction = friction_of(answer["friction_nm"], file.string());
  wheel.doubt = doubt_of(whole);
  return wheel;
}

std::optional<WheelAlone> wheel_of(const Identification& found) {
  if (!found.wheel || found.wheel->verdict != WheelBetween::Verdict::kAgree) return std::nullopt;
  return WheelAlone{found.wheel->fit.inertia, found.wheel->fit.damping, "torque_rim and torque_bar"};
}

std::optional<OwnArm> own_arm(const Identification& found, const WheelAlone& wheel) {
  if (found.equation == Equation::kRim || found.equation == Equation::kDriverRim) return std::nullopt;
  return OwnArm{less(found.inertia_kgm2, wheel.inertia), less(found.damping_nms_per_rad, wheel.damping),
                wheel.stiffness.sd > 0 ? less(found.stiffness_nm_per_rad, wheel.stiffness) : found.stiffness_nm_per_rad,
                wheel};
}

std::string own_arm_table(const OwnArm& arm) {
  return fmt::format("driver's own arm, less the wheel of {}\n", arm.wheel.from) +
         parameter_line("inertia J", "kg m2", arm.inertia_kgm2) +
         parameter_line("damping B", "Nms/rad", arm.damping_nms_per_rad) +
         parameter_line("stiffness C", "Nm/rad", arm.stiffness_nm_per_rad);
}

nlohmann::ordered_json own_arm_json(const OwnArm& arm) {
  return {{"inertia_kgm2", parameter_json(arm.inertia_kgm2)},
          {"damping_nms_per_rad", parameter_json(arm.damping_nms_per_rad)},
          {"stiffness_nm_per_rad", parameter_json(arm.stiffness_nm_per_rad)},
          {"wheel", arm.wheel.from}};
}

}  // namespace steerid
