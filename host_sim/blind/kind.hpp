// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The kinds of things that can be wrong: how each one's numbers are drawn, what scales it, and the element that does
// it. The families are one file each; catalogue.hpp joins them.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blind/draw.hpp"
#include "blind/drive.hpp"
#include "blind/element.hpp"
#include "blind/simulation.hpp"

namespace steerid::blind {

/// Named numbers, their units in their names; the names of effects of the vocabulary are those of host_sim/plant.
class Numbers {
 public:
  Numbers() = default;
  Numbers(std::initializer_list<std::pair<std::string, double>> all) : all_(all) {}
  /// Throws std::logic_error when there is none of that name.
  [[nodiscard]] double operator[](std::string_view name) const;
  [[nodiscard]] double& at(std::string_view name);
  [[nodiscard]] const std::vector<std::pair<std::string, double>>& all() const { return all_; }

 private:
  std::vector<std::pair<std::string, double>> all_;
};

/// The drive that an effect meets, measured on its linear twin, and the wheel's own part of J and B.
struct Setting {
  Task task = Task::kProbe;
  Arm arm;
  double wheel_inertia_share = 0.3;
  double wheel_damping_share = 0.05;
  double duration_s = 60;
  double torque_rms_nm = 1;   ///< of T_driver - T_motor
  double torque_peak_nm = 1;  ///< of the channel that swings most
  double angle_rms_rad = 0.1;
  double angle_peak_rad = 0.2;
  double rate_rms_rad_s = 1;
  std::uint64_t seed = 1;  ///< of elements that act by chance
};

/// What makes an effect stronger: the distance of this number from `origin`.
struct Size {
  std::string_view name;
  double low;  ///< what is still physical
  double high;
  double origin = 0;
  bool weaker_when_larger = false;  ///< a limit, a compliance's stiffness
};

struct Kind {
  std::string_view id;
  std::span<const Size> sizes;
  Numbers (*draw)(Draw& draw, const Setting& setting);
  std::unique_ptr<Element> (*make)(const Numbers& numbers, const Setting& setting);
  bool needs_large_angles = false;  ///< shown by no other drive than the active one
  bool keeps_drawn_size = false;    ///< its size is a definition, not to be fitted to a gap
};

/// The numbers with the effect `factor` times as strong, or as near to it as all its sizes stay physical; they keep
/// their ratio.
[[nodiscard]] Numbers scaled(const Kind& kind, const Numbers& numbers, double factor);

/// The families.
[[nodiscard]] std::span<const Kind> friction_kinds();
[[nodiscard]] std::span<const Kind> joint_kinds();
[[nodiscard]] std::span<const Kind> torque_kinds();
[[nodiscard]] std::span<const Kind> record_kinds();
[[nodiscard]] std::span<const Kind> outside_plant_kinds();   ///< none of the vocabulary, in the plant
[[nodiscard]] std::span<const Kind> outside_sensor_kinds();  ///< none of the vocabulary, in sensors and actuators

/// Makes an element of a class whose constructor takes (numbers, setting).
template <class Class>
std::unique_ptr<Element> make_element(const Numbers& numbers, const Setting& setting) {
  return std::make_unique<Class>(numbers, setting);
}

}  // namespace steerid::blind
