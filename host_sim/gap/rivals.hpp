// What no effect of the vocabulary is, but a real wheel may be: shapes that a missing effect can take, without a name.
//
// A library can only say `unknown` of what it lacks if something else speaks up for it. Here that is four families of
// torques, linear in their coefficients, on the measured motion and on the recorded torques:
//   surface   polynomials and kinks of angle and rate: springs, stops and dampings of any form
//   course    inertia, damping, stiffness and dry friction that change through the record, as polynomials and steps of
//             time
//   dynamics  a response of another order: powers of i w on the predicted angle, whole and broken
//   channel   a driver's torque that is not what the sensor says: another gain, or late
// A family is fitted on top of a model - the plain wheel, or a wheel with an effect - by linear least squares on the
// fitted blocks, the model's own parameters moving with it, and judged on the blocks that choose. What it gains on top
// of the plain wheel makes it a rival of the effects; what it gains on top of an effect says that the effect left
// something that is neither noise nor chance.
#pragma once

#include <string_view>
#include <vector>

#include "gap/spectral_model.hpp"
#include "gap/whittle.hpp"

namespace steerid {

struct Rival {
  std::string_view family;
  double fit_nats = 0;     ///< gained on the fitted blocks
  double choose_nats = 0;  ///< gained on the blocks that choose, with the coefficients of the fitted ones
  int free = 0;            ///< coefficients
  double left = 0;         ///< what there was to explain: the misfit of both above the floor, nats
};

/// The families' gains on top of `model` at `fit`, above `floor`. `slopes` gives the derivatives to x.
[[nodiscard]] std::vector<Rival> rivals_beyond(const SpectralRecord& record, const Whittle& whittle,
                                               ResidualModel& model, ResidualModel& slopes, const Eigen::VectorXd& x,
                                               const NoiseFloor& floor, const std::vector<Fitted>& fitted);

}  // namespace steerid
