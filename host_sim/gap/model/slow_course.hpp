// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The course of a slow torque that nobody measured, in a run that it moves.
//
// A linear wheel adds the slow torque's motion to its run, whatever that run is, and the likelihood takes it for a part
// of its noise (gap/likelihood/noise_floor.hpp). A wheel that sticks or has backlash does not: that torque decides when
// it leaves. Nor does one that was let go, which it moves many times as far, nor one on a spring that bends or ripples,
// which is another spring elsewhere. There a run without the torque strays from the record though every number is
// right. So its course is estimated along with the run, as a smoother does (gap/model/course_fit.hpp).
//
// What the linear wheel would make of that course is given back to the residual,
//
//   r = angle - run(T + d) + H d
//
// and the likelihood counts the torque as it counts any. For a linear wheel r is that of the plain run whatever d is:
// the course is where the run is taken as linear in the slow torque, no number that is free to explain anything. Nor
// need H follow J, B and C in a fit: at the best d the likelihood's derivative to H d is zero (envelope theorem). The
// course itself follows them (`following`), as that of a set makes up for what the set lacks.
// docs/adr/0013
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "gap/model/course_fit.hpp"
#include "gap/model/spectral_model.hpp"
#include "plant/effects/effect.hpp"

namespace steerid::gap {

struct SlowCourse {
  Effect torque;      ///< an unmeasured torque with its time course
  Spectrum response;  ///< H d: what a linear wheel's angle makes of it, rad

  /// How it moves with the numbers of a fit.
  struct Following {
    Eigen::VectorXd from;             ///< the numbers where it is the torque above
    Eigen::MatrixXd course_nm;        ///< a row a coefficient, a column a number: Nm per unit
    std::vector<Spectrum> responses;  ///< H times those columns
    std::vector<Spectrum> slopes;     ///< by how much more the residual moves than with the course held, one a number
  };
  std::shared_ptr<const Following> follows{};  ///< none: the course is held

  /// The same held where it is at x.
  [[nodiscard]] SlowCourse held_at(const Eigen::VectorXd& x) const;
};

/// What drivers have of it, and the angle's own noise; `kCause`: as large as where it is a cause.
[[nodiscard]] SlowPrior slow_prior(const SpectralRecord& record, const Whittle& whittle, SlowTorque slow);

/// The course at a point: `rounds` of Gauss-Newton at most, of 15 runs of the record each, from an earlier one or,
/// where that is null, none. `threads` share the runs (0: one a core). A run that diverges ends the search where it is.
[[nodiscard]] SlowCourse slow_course(const SpectralRecord& record, const Point& at, const SlowPrior& prior, int rounds,
                                     const SlowCourse* from = nullptr, unsigned threads = 1);

/// The same course, which gives up along a fit from x what the numbers take over, and takes up what they leave: a
/// course that is held holds a fit by what it makes up for. Costs a run a number and some twenty more. Where a run
/// diverges nothing follows.
[[nodiscard]] SlowCourse following(const SpectralRecord& record, const Parts& parts, const Eigen::VectorXd& x,
                                   const std::vector<Fitted>& fitted, const SlowPrior& prior, const SlowCourse& course,
                                   unsigned threads = 1);

}  // namespace steerid::gap
