// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// From a comparison to probabilities.
//
// Among what the vocabulary can say: a softmax over scores. The score of an id is its log likelihood on the part that
// was fitted and on the part that was not, less what its free parameters would gain by chance, divided by the
// dispersion, the excess of the best fit over the floor, because where even the best model misses something a
// difference of so many nats says that much less (quasi-likelihood, McCullagh and Nelder 1989); and less a price for
// moving J, B and C far from what the simulation had, the more where they have to be out of place: of two that explain
// a record alike the one that leaves them where they were is meant. Stribeck's friction, which holds Coulomb's, has to
// prove itself besides: it must explain a tenth of what Coulomb's leaves. A fit far below the floor is out: its wheel
// resonates and makes its own noise.
//
// Against them stands `unknown`: a logistic function of the logarithms of how far the best fit stays above the floor
// and of the share of the gap that it leaves open, whichever speaks less for it. Both are needed: a strong effect that
// is modelled to one per cent leaves an excess that is plain but small beside what it closed, and a weak one leaves a
// share that is nothing but noise. A slow torque of the floor that is larger than any driver's speaks for unknown: it
// is what a model misses. So do a free run that strays; a slow torque that is a single tone; J, B and C that have to go
// further from the simulation's than simulations are off; and, where nothing but J, B and C is to explain the record,
// noise that is none. Shapes without a name (gap/comparison/rivals.hpp) speak for unknown, too: families of them that
// explain most of what the best fit leaves, single ones that explain a quarter. Where all this speaks for neither, odds
// decide: a wrong name costs more than none.
//
// The coefficients (gap/attribution/attribution_coefficients.hpp) were set by hand on labelled records. They are no
// calibration: how often an effect is right that is given 0.9 is measured afterwards, on records drawn by `steerid
// study blind` (docs/gap_diagnosis.md).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gap/attribution/evidence.hpp"
#include "gap/comparison/comparison.hpp"

namespace steerid {

struct AttributionInput {
  std::vector<Evidence> all;  ///< one an id of the comparison
  double refit_excess = 1;
  double noise_departure = 0;  ///< of what is taken for the angle's noise from normal (gap/likelihood/noise_shape.hpp)
};

/// What shapes without a name gain on top of a fit that is then half unknown; both at once.
struct Claim {
  double nats = 0;   ///< beyond the price of its coefficients
  double share = 0;  ///< of what the fit leaves
};

struct AttributionCoefficients {
  double fit = 1;     ///< weight of the fitted blocks' likelihood
  double choose = 1;  ///< of the unseen blocks'
  double complexity = 1;
  double shift = 1;
  double dispersion_power = 1;
  double none = 0;          ///< added to the score of none
  double unknown_odds = 1;  ///< of unknown against a name where the evidence speaks for neither
  double unknown_sharpness = 4;
  double unknown_excess = 0.55;    ///< excess over the floor at which a fit is half unknown, if its share is there too
  double unknown_unclosed = 0.13;  ///< share of the gap left open, likewise
  Claim family{12, 0.5};           ///< of several shapes
  Claim shape{5, 0.25};            ///< of a single one, which knows what it looks for
};

[[nodiscard]] AttributionInput attribution_input(const Comparison& comparison, const Whittle& whittle,
                                                 const WheelArm& sim);

/// What the candidate leaves, where that was noted since (gap/attribution/what_is_left.hpp).
void take_what_is_left(Evidence& evidence, const Candidate& noted);

/// Minus log likelihood of all that was seen, with the price of the free parameters.
[[nodiscard]] inline double priced_nats(const Evidence& one) { return one.fit_nats + one.choose_nats + one.complexity; }

/// A grip that leaves the wheel none of the inertia only filters the torque, and a hand that takes all of it with it
/// lets the wheel go anywhere at once: they stand in for a lag, and for whatever is off at single moments.
[[nodiscard]] bool leaves_wheel_inertia(const Effect& effect);

/// A slow sinusoid or a slow torque that is no larger than every driver's own is no cause; nor is a difference of dry
/// friction between the directions, or between rest and motion, that is no larger than what such a torque leaves on
/// average. Without it both are Coulomb friction by another name. A ripple of which the wheel never sees a whole cycle,
/// and friction that never slides, are bent springs without a name; a grip on a wheel without inertia is a filter, and
/// a hand that leaves none behind any moment at which something else is off.
[[nodiscard]] bool beyond_the_floor(const Candidate& candidate, const Whittle& whittle, double swing_rad);

/// Probabilities in the order of input.all, and that of unknown last.
[[nodiscard]] std::vector<double> attribute(const AttributionInput& input, const AttributionCoefficients& by);

/// The place in input.all of what is most probable beside unknown.
[[nodiscard]] std::size_t likeliest_of(const std::vector<double>& probability);

}  // namespace steerid
