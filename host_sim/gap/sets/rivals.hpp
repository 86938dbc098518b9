// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What no effect of the vocabulary is, but a real wheel may be: shapes that a missing effect can take, without a name.
//
// A library can only say `unknown` of what it lacks if something else speaks up for it. Here that is four families of
// torques, linear in their coefficients, on the wheel's motion and on the recorded torques, both without the noise that
// the fit leaves, too: it would explain itself with the wrong sign (docs/adr/0014):
//   surface   polynomials and kinks of angle and rate: springs, stops and dampings of any form
//   course    inertia, damping, stiffness, dry friction and a torque that change through the record, as polynomials and
//             steps of time; a torque that settles, and one that stays
//   dynamics  a response of another order: powers of i w on the predicted angle, whole and broken
//   channel   a driver's torque that is not what the sensor says: another gain, or late
// A family, and every one of its shapes alone, is fitted on top of a model - the plain wheel, or a wheel with an effect
// - on the fitted blocks, the model's own parameters and the slow torque of the floor moving with it, and judged on the
// blocks that choose. The slow torque must move: without the shape it has grown to hold what the model misses, and what
// a shape explains it gives back. What a shape gains on top of an effect says that the effect left something that is
// neither noise nor chance.
//
// Its coefficients have a price, and so has its choice among all of them: the best of many shapes gains by chance.
#pragma once

#include <vector>

#include "gap/likelihood/whittle.hpp"
#include "gap/model/spectral_model.hpp"

namespace steerid::gap {

/// What the best of the families and their shapes gains beyond its price on top of `model` as fitted `at`, over what is
/// left a line; 0 where none gains as much. `slopes`: by how much the residual moves with each of the model's numbers,
/// which are `fitted`. `slow`: what its slow torque is.
[[nodiscard]] double rival_nats(const SpectralRecord& record, const Whittle& whittle, ResidualModel& model,
                                std::vector<Spectrum> slopes, const Whittle::Fit& at, const std::vector<Fitted>& fitted,
                                SlowTorque slow, unsigned threads);

}  // namespace steerid::gap
