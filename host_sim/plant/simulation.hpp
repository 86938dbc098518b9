// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A simulated wheel as a file holds it, JSON:
//
//   {"inertia_kgm2": 0.11, "damping_nms_per_rad": 1.5, "stiffness_nm_per_rad": 22.7,
//    "effects": [{"effect": "coulomb_friction", "parameters": {"friction_nm": 0.4}}],
//    "torque_between_samples": "band_limited",
//    "sensors": {...}}
//
// Inertia, damping and stiffness are required: J > 0, B >= 0, C >= 0. The rest is optional.
//   effects                 any of the vocabulary (plant/effects/vocabulary.hpp), in the order in which they act on the
//                           record; parameters left out take their presets. unmeasured_torque also takes
//                           "time_course_nm", a list of numbers.
//   torque_between_samples  "band_limited" (the default) or "held", see plant/torque_signal.hpp
//   sensors                 kept as it stands for whoever simulates sensors
// A wheel so stiff beside its inertia that following it would take more than kMostStepsPerS is refused: a run over a
// minute would take minutes, and a diagnosis makes thousands. A driver's arm takes some hundreds.
// Anything else, a number out of range or of the wrong kind is BadInput, one sentence with the file and the place in it
// (a JSON pointer, RFC 6901).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "plant/effects/vocabulary.hpp"
#include "plant/free_run.hpp"
#include "plant/torque_signal.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid {

inline constexpr double kMostStepsPerS = 20'000;

struct Simulation {
  WheelArm wheel;
  std::vector<Effect> effects;
  TorqueSignal::Between torque_between_samples = TorqueSignal::Between::kBandLimited;
  std::string sensors_json;  ///< the object under "sensors", empty when there is none

  /// `name` stands for the text in messages.
  static Simulation from_json(std::string_view text, std::string_view name);
  static Simulation load(const std::filesystem::path& file);
  /// Throws BadInput when the wheel is too stiff to be followed; `name` stands for it in the sentence.
  void check_cost(std::string_view name) const;
  /// What from_json() reads back unchanged.
  [[nodiscard]] std::string to_json() const;
};

/// The angle that the simulation takes under the record's torques, one value a sample of the record. For many runs on
/// one record use FreeRun.
[[nodiscard]] std::vector<double> free_run(const Simulation& simulation, const Record& record,
                                           const std::optional<WheelState>& initial = std::nullopt);

}  // namespace steerid
