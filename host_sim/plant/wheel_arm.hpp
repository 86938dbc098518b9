// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The linear wheel and arm, J th'' + B th' + C th = T_driver - T_motor (Lv et al. 2018, equation 1), its numbers and
// what follows from them in closed form.
#pragma once

#include <optional>
#include <string_view>

namespace steerid {

struct WheelArm {
  double inertia_kgm2 = 0.11;          ///< J = J_driver + J_wheel; 0.02 to 0.18 (tables I and II)
  double damping_nms_per_rad = 1.5;    ///< B = B_driver + B_wheel; 0.1 to 4.4
  double stiffness_nm_per_rad = 22.7;  ///< C, the driver's co-contraction; 4.5 to 80.5

  /// xi = B/(2 sqrt(J C)); nothing without stiffness and inertia, C <= 0 or J <= 0.
  [[nodiscard]] std::optional<double> damping_ratio() const;
};

/// Equation 5, f = sqrt((1 - xi^2) C/J)/(2 pi), or why the wheel has no natural frequency.
struct NaturalFrequency {
  enum class Defined {
    kYes,
    kOverdamped,   ///< xi >= 1: the wheel returns without swinging (table II's nominal row has xi = 1.37)
    kNoStiffness,  ///< C <= 0: nothing pulls the wheel back
    kNoInertia,    ///< J <= 0 or not a number: not a wheel
  };
  Defined defined = Defined::kNoInertia;
  double hz = 0;  ///< 0 unless defined is kYes

  /// "overdamped", "no stiffness", "no inertia"; empty when it is defined.
  [[nodiscard]] std::string_view reason() const;
};

[[nodiscard]] NaturalFrequency natural_frequency(const WheelArm& wheel);

}  // namespace steerid
