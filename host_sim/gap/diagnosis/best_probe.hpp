// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The bounded probe of the EPS that tells models of a wheel apart best.
//
// Multisines of several bands and sizes are simulated on all models. For two models with known numbers a probe with
// torque spectrum T is worth sum |H1 T - H2 T|^2 / S nats, S the noise floor's density (T-optimality: Atkinson and
// Fedorov 1975). Their numbers are not known: of the two, the one with fewer free numbers is fitted to the other's
// answer, to first order, and what that leaves counts. The reverse is no question, as the richer one may hold the
// poorer. Where even the best model is above the floor nats are divided by its excess, as in gap/sets/set_fit.hpp.
//
// The first model is compared with each of the others. One of weight p that is told apart by N nats counts
// p log(1 + N): with the logarithm of the odds a change's calibrated probability grows (gap/sets/inclusion.cpp). Of
// models for one change that is in doubt the one that is told apart least counts: only all of them settle it.
//
// Bounds: no more torque than an EPS grants (5 Nm) or the record itself applied; and with none of the models more
// travel than half as much again as the record's. There is no least torque: what is too weak to rise above the floor
// separates nothing.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "gap/diagnosis/diagnosis.hpp"
#include "gap/likelihood/noise_floor.hpp"
#include "gap/likelihood/whittle.hpp"
#include "gap/model/point.hpp"
#include "gap/preparation/prepared_record.hpp"

namespace steerid::gap {

/// A model that may be right.
struct Standing {
  std::string name;
  double weight = 0;  ///< the probability that it is right; the first model's is not used
  Point at;
  std::vector<Fitted> fitted;  ///< one a number; one that is held has a step of 0
  /// The change that is in doubt as long as this model is not told from the first one; of the first one none.
  const EffectType* doubted = nullptr;
};

struct ProbeSetting {
  const PreparedRecord& prepared;
  NoiseFloor floor;       ///< with its slow torque
  double dispersion = 1;  ///< what nats are divided by
  unsigned threads = 0;
};

/// What may stay open of something that is settled, as every interval of a diagnosis leaves it.
inline constexpr double kDoubt = 0.05;
/// The least separation that settles anything, nats: the log of its odds.
[[nodiscard]] inline double settling_nats() { return std::log((1 - kDoubt) / kDoubt); }

/// Of two models at least. Where no probe separates the first one from any other by settling_nats(), `separates` is
/// empty and `why` says so. Costs some 400 runs of 20 s.
[[nodiscard]] NextExperiment best_probe(const std::vector<Standing>& models, const ProbeSetting& setting);

}  // namespace steerid::gap
