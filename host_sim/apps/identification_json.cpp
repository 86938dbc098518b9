// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/identification_json.hpp"

#include <cmath>

#include "apps/channel_words.hpp"

namespace steerid {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinity: a number that is not finite is unknown, and unknown is null.
Json number(std::optional<double> value) { return value && std::isfinite(*value) ? Json(*value) : Json(nullptr); }

Json natural_frequency_json(const FrequencyAnswer& frequency) {
  Json json = {{"value", number(frequency.hz)}};
  if (!frequency.hz) json["reason"] = frequency.reason;
  return json;
}

Json fitted_json(const FittedNumber& fitted) { return {{"value", fitted.value}, {"sd", fitted.sd}}; }

void add_answer(Json& json, const Identification& found) {
  const FrequencyAnswer frequency = frequency_answer(found);
  json["method"] = found.method;
  json["inertia_kgm2"] = parameter_json(found.inertia_kgm2);
  json["damping_nms_per_rad"] = parameter_json(found.damping_nms_per_rad);
  json["stiffness_nm_per_rad"] = parameter_json(found.stiffness_nm_per_rad);
  json["natural_frequency_hz"] = natural_frequency_json(frequency);
  json["damping_ratio"] = number(frequency.damping_ratio);
  json["amplitude_fit_percent"] = number(found.amplitude_fit_percent);
  json["free_run_nrmse"] = number(found.free_run_nrmse);
  if (!voluntary_torque_known(found.equation)) {
    json["probe_driven_nrmse"] =
        found.driven ? Json{{"value", number(found.driven->nrmse)}, {"by_noise", number(found.driven->by_noise)}}
                     : Json();
    json["unmeasured_torque_nm"] = number(found.unmeasured_torque_nm);
  }
  if (found.friction_nm) json["friction_nm"] = fitted_json(*found.friction_nm);
  if (!found.doubt.empty()) json["doubt"] = found.doubt;
}

Json wheel_json(const WheelBetween& wheel) {
  using Verdict = WheelBetween::Verdict;
  Json json = Json::object();
  if (wheel.verdict == Verdict::kAgree) {
    json["inertia_kgm2"] = fitted_json(wheel.fit.inertia);
    json["damping_nms_per_rad"] = fitted_json(wheel.fit.damping);
  }
  json["gain"] = fitted_json(wheel.gain);
  json["sensors_agree"] = wheel.verdict == Verdict::kUnknown ? Json(nullptr) : Json(wheel.verdict == Verdict::kAgree);
  json["says"] = wheel_words(wheel);
  return json;
}

}  // namespace

nlohmann::ordered_json parameter_json(const IdentifiedParameter& parameter) {
  Json json = {{"value", number(parameter.value)}, {"sd", number(parameter.sd)}, {"state", name(parameter.state)}};
  if (parameter.at_most) json["at_most"] = *parameter.at_most;
  return json;
}

nlohmann::ordered_json identification_json(const Identification& recursive,
                                           const std::optional<Identification>& batch) {
  Json json = {{"schema", "steerid.identify/1"}, {"equation", name(recursive.equation)}};
  add_answer(json, recursive);
  if (recursive.wheel) json["wheel"] = wheel_json(*recursive.wheel);
  if (batch) {
    Json batch_json = Json::object();
    add_answer(batch_json, *batch);
    json["batch"] = batch_json;
  }
  return json;
}

}  // namespace steerid
