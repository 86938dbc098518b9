// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/over_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "apps/credibility.hpp"

namespace steerid {
namespace {

constexpr std::size_t kOneIn = 5;  // of 25 a second

std::vector<double> thinned(const std::vector<double>& all) {
  std::vector<double> some;
  for (std::size_t i = 0; i < all.size(); i += kOneIn) some.push_back(all[i]);
  return some;
}

/// The smallest and the largest value, each with its standard deviation.
std::string range(const std::vector<double>& values, const std::vector<double>& sd) {
  const auto [low, high] = std::ranges::minmax_element(values);
  const auto words = [&](auto at) {
    return fmt::format("{:.3g} +- {:.2g}", *at, sd[static_cast<std::size_t>(at - values.begin())]);
  };
  return fmt::format("{} to {}", words(low), words(high));
}

}  // namespace

std::string hold_change_against(VaryingArm& arm, const ModelCheck& check) {
  if (!arm.changes || check.alternatives.empty()) return "";
  const Alternative& likeliest = check.alternatives.front();
  const double change_nats = arm.likelihood_ratio / 2;
  if (likeliest.evidence_nats <= change_nats) return "";
  arm = VaryingArm{};
  return fmt::format(
      "B and C over time are not told: an arm that changes makes the record e^{:.0f} times likelier, {} e^{:.0f} times",
      change_nats, alternative_words(likeliest), likeliest.evidence_nats);
}

std::string over_time_line(const VaryingArm& arm) {
  const auto line = [](const std::string& text) { return fmt::format("  {:<18}{}\n", "over time", text); };
  if (arm.time_s.empty()) return line(arm.compared ? "no change that the record's likelihood shows" : "not told");
  return line(fmt::format("C {} Nm/rad, B {} Nms/rad; J, B, C above are of an arm that stays (--json, --report)",
                          range(arm.stiffness, arm.stiffness_sd), range(arm.damping, arm.damping_sd)));
}

nlohmann::ordered_json over_time_json(const std::optional<VaryingArm>& arm) {
  if (!arm || !arm->compared) return nullptr;
  nlohmann::ordered_json json = {{"changes", arm->changes}, {"likelihood_ratio", arm->likelihood_ratio}};
  if (arm->time_s.empty()) return json;
  json["time_s"] = thinned(arm->time_s);
  json["damping_nms_per_rad"] = thinned(arm->damping);
  json["damping_sd_nms_per_rad"] = thinned(arm->damping_sd);
  json["stiffness_nm_per_rad"] = thinned(arm->stiffness);
  json["stiffness_sd_nm_per_rad"] = thinned(arm->stiffness_sd);
  return json;
}

}  // namespace steerid
