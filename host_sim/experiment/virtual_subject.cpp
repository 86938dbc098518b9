// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "experiment/virtual_subject.hpp"

#include <algorithm>
#include <cmath>

#include "sensors/random.hpp"

namespace steerid {
namespace {

constexpr double kExtremeOfTen = 1.5388;  // expected largest of ten standard normal numbers (Harter 1961)
constexpr std::uint64_t kFirstStream = 2000;
constexpr double kBothInertia = 1.15;
constexpr double kBothDamping = 1.15;
constexpr double kBothStiffness = 1.3;

/// `share` of the standard deviation in common, the rest apart; standard normal when both are.
double mixed(double share, double common, double apart) {
  return share * common + std::sqrt(1 - share * share) * apart;
}

PublishedRange inertia_range(HandPosition hands) {
  const PublishedRange& passive = published_row(TaskKind::kPassive, hands).inertia_kgm2;
  const PublishedRange& active = published_row(TaskKind::kActive, hands).inertia_kgm2;
  return {passive.nominal, std::min(passive.low, active.low), std::max(passive.high, active.high)};
}

struct Traits {
  double inertia;
  double stiffness;
};

WheelArm draw_arm(TaskKind task, HandPosition hands, double inertia_z, const Traits& traits, Random& random) {
  const PublishedRow& row = published_row(task, hands);
  const bool both = both_arms(hands);
  const double stiffness_z = mixed(0.8, traits.stiffness, random.normal());
  const double damping_z = mixed(0.5, stiffness_z, random.normal());
  return {value_at(inertia_range(hands), inertia_z) * (both ? kBothInertia : 1.0),
          value_at(row.damping_nms_per_rad, damping_z) * (both ? kBothDamping : 1.0),
          value_at(row.stiffness_nm_per_rad, stiffness_z) * (both ? kBothStiffness : 1.0)};
}

}  // namespace

double value_at(const PublishedRange& range, double z) {
  const double part = std::clamp(z / kExtremeOfTen, -1.0, 1.0);
  return range.nominal * std::pow((part > 0 ? range.high : range.low) / range.nominal, std::abs(part));
}

std::vector<VirtualSubject> virtual_subjects(std::uint64_t seed, std::size_t count) {
  std::vector<VirtualSubject> subjects(count);
  for (std::size_t i = 0; i < count; ++i) {
    Random random(seed, kFirstStream + i);
    const Traits traits{random.normal(), random.normal()};
    std::array<double, 3> inertia_z{};  // one a grip: the same arm in the same place, whatever the task and the posture
    for (double& z : inertia_z) z = mixed(0.97, traits.inertia, random.normal());
    for (std::size_t at = 0; at < kAllHandPositions.size(); ++at) {
      const HandPosition hands = kAllHandPositions[at];
      subjects[i].passive[at] = draw_arm(TaskKind::kPassive, hands, inertia_z[at % 3], traits, random);
      subjects[i].active[at] = draw_arm(TaskKind::kActive, hands, inertia_z[at % 3], traits, random);
    }
  }
  return subjects;
}

}  // namespace steerid
