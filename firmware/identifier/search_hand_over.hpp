// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the steady identifier's refining takes over of a search: how much it trusts, and which parameters.
//
//   P := h P                 h = 100 after a search from the prior, 3 after one for another arm, behind filters that
//                            were tuned before
//   to the prior             a parameter that the motion did not show 3 times better than the angle's noise pretends
//                            to: least squares on noise finds confident nonsense
//   deviation to the prior   the same, 80 times: it is held until more is shown
//   all to the prior         where the search leaves half and more of the torque's power unexplained
//
// The last: a wheel at rest is moved by torque that no sensor sees, and what the measured torque does not explain shows
// nothing. Never twice running: the prior itself leaves more than that, and the mean over a second still holds it at
// the end of the next search. What is taken over is then forgotten quickly (directional_forgetting.hpp), since it was
// found by a poorer instrument: kForgetting a sample at first.
//
// Units: those of the covariance (ud_covariance.hpp). Once a search. A byte.
#pragma once

#include "identifier/parameters.hpp"
#include "identifier/ud_covariance.hpp"
#include "identifier/window_information.hpp"

namespace steerid {

template <class Scalar>
class SearchHandOver {
 public:
  static constexpr double kForgetting = 0.05;         ///< of what refining starts with
  static constexpr double kForgettingAnother = 0.25;  ///< while another arm is searched for, of the last one

  /// How many times the variance that a search claims is believed.
  [[nodiscard]] static Scalar variance_factor(bool another_arm) {
    return another_arm ? Scalar(kAnother) : Scalar(kFromPrior);
  }

  /// Nothing was searched for yet.
  void reset() { dismissed_ = false; }

  /// After a search from the prior. `share`: how much of what each parameter showed noise alone makes
  /// (WindowInformation::noise_share). `left`, `whole`: mean squares of the residual and of the torque, Nm^2.
  /// `variance`: of the residual. Returns what is held from now on.
  template <class Parameters>
  [[nodiscard]] Held take_over(Parameters& p, UdCovariance<Scalar>& covariance, const Vector3<Scalar>& share,
                               Scalar left, Scalar whole, Scalar variance, const Prior<Scalar>& prior) {
    Held unexcited = held_by(share, Scalar(1.0 / kShownToSearch));
    Held held = held_by(share, Scalar(1.0 / kShown));
    dismissed_ = left > Scalar(kUnexplained) * whole && !dismissed_;
    if (dismissed_) unexcited = held = Held::kAll;
    for (int i = 0; i < 3; ++i) {
      if (holds(unexcited, i)) p.set(i, prior.value(i));
      if (!holds(held, i)) continue;
      covariance.spread(Vector3<Scalar>::Unit(i) * prior.spread(i), Scalar(1) / variance);
    }
    return held;
  }

 private:
  static constexpr double kFromPrior = 100;
  static constexpr double kAnother = 3;
  static constexpr double kShownToSearch = 3;
  static constexpr double kUnexplained = 0.5;  ///< share of the torque's power that a search may leave

  bool dismissed_ = false;  ///< what the last search had found
};

}  // namespace steerid
