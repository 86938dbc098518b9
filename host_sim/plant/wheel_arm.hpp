// The linear wheel and arm, J th'' + B th' + C th = T_driver - T_motor (Lv et al. 2018, equation 1), its numbers and
// what follows from them in closed form.
#pragma once

namespace steerid {

struct WheelArm {
  double inertia_kgm2 = 0.11;         ///< J = J_driver + J_wheel; 0.02 to 0.18 (tables I and II)
  double damping_nms_per_rad = 1.5;   ///< B = B_driver + B_wheel; 0.1 to 4.4
  double stiffness_nm_per_rad = 22.7; ///< C, the driver's co-contraction; 4.5 to 80.5
};

}  // namespace steerid
