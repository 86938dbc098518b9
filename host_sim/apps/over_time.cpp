// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/over_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "apps/answers.hpp"
#include "apps/credibility.hpp"
#include "fit/certainty.hpp"

namespace steerid {
namespace {

constexpr std::size_t kOneIn = 5;  // of 25 a second

std::vector<double> thinned(const std::vector<double>& all) {
  std::vector<double> some;
  for (std::size_t i = 0; i < all.size(); i += kOneIn) some.push_back(all[i]);
  return some;
}

/// The smallest and the largest value, each with its standard deviation.
std::string range(const VaryingArm::Course& course) {
  const auto [low, high] = std::ranges::minmax_element(course.value);
  const auto words = [&](auto at) {
    return fmt::format("{:.3g} +- {:.2g}", *at, course.sd[static_cast<std::size_t>(at - course.value.begin())]);
  };
  return fmt::format("{} to {}", words(low), words(high));
}

}  // namespace

std::string hold_change_against(VaryingArm& arm, const ModelCheck& check) {
  std::vector<Alternative> all = check.alternatives;
  if (arm.stays_otherwise) all.push_back(*arm.stays_otherwise);
  if (!arm.changes || all.empty()) return "";
  const Alternative likeliest = *std::ranges::max_element(all, {}, &Alternative::evidence_nats);
  const double change_nats = arm.likelihood_ratio / 2;
  if (!(likeliest.evidence_nats > change_nats)) return "";
  arm = VaryingArm{};
  return fmt::format(
      "B and C over time are not told: an arm that changes makes the record e^{:.0f} times likelier, {} e^{:.0f} times",
      change_nats, alternative_words(likeliest), likeliest.evidence_nats);
}

void widen(Identification& found, const VaryingArm& arm) {
  const auto by_course = [](IdentifiedParameter& parameter, const VaryingArm::Course& course) {
    std::vector<double> off;
    for (std::size_t i = 0; i < course.value.size(); ++i) {
      const double beyond_noise = std::pow(course.value[i] - parameter.value, 2) - std::pow(course.sd[i], 2);
      off.push_back(std::sqrt(std::max(0.0, beyond_noise)));
    }
    const auto most = off.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(off.size()));
    std::ranges::nth_element(off, most);
    widen(parameter, *most / kNormal95, ParameterState::kConverging);
  };
  if (arm.time_s.empty()) return;
  if (arm.inertia_changes()) by_course(found.inertia_kgm2, arm.inertia);
  by_course(found.damping_nms_per_rad, arm.damping);
  by_course(found.stiffness_nm_per_rad, arm.stiffness);
}

std::string over_time_line(const VaryingArm& arm) {
  const auto line = [](const std::string& text) { return fmt::format("  {:<18}{}\n", "over time", text); };
  if (arm.time_s.empty()) return line(arm.compared ? "no change that the record's likelihood shows" : "not told");
  const std::string inertia = arm.inertia_changes() ? fmt::format(", J {} kg m2", range(arm.inertia)) : "";
  return line(
      fmt::format("C {} Nm/rad, B {} Nms/rad{} (--json, --report)", range(arm.stiffness), range(arm.damping), inertia));
}

nlohmann::ordered_json over_time_json(const std::optional<VaryingArm>& arm) {
  if (!arm || !arm->compared) return nullptr;
  nlohmann::ordered_json json = {{"changes", arm->changes}, {"likelihood_ratio", arm->likelihood_ratio}};
  if (arm->time_s.empty()) return json;
  json["time_s"] = thinned(arm->time_s);
  const auto add = [&](const std::string& name, const std::string& unit, const VaryingArm::Course& course) {
    json[name + "_" + unit] = thinned(course.value);
    json[name + "_sd_" + unit] = thinned(course.sd);
  };
  if (arm->inertia_changes()) add("inertia", "kgm2", arm->inertia);
  add("damping", "nms_per_rad", arm->damping);
  add("stiffness", "nm_per_rad", arm->stiffness);
  return json;
}

}  // namespace steerid
