// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// From a hypothesis to its best parameters: a linear scan over its starts, then Gauss-Newton from the best of them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "gap/hypotheses/hypothesis.hpp"
#include "gap/likelihood/whittle.hpp"
#include "gap/model/spectral_model.hpp"
#include "gap/sets/projection.hpp"

namespace steerid::gap {

/// How much a torque explains of what the linear wheel leaves, J, B, C being free to move a little: a linear problem,
/// Rao's score test.
class LinearScan {
 public:
  /// Around the model of `parts` at `fit`, on the blocks of `roles`; `offset` is the model's. `free`: by how much the
  /// residual moves with each number that is free to move.
  LinearScan(const SpectralRecord& record, const Parts& parts, const Whittle::Fit& fit, const Whittle::Roles& roles,
             const Spectrum& offset, const std::vector<Spectrum>& free);

  struct Gain {
    double nats = 0;
    double first = 0;  ///< the factors of the torques tried
    double second = 0;
  };
  [[nodiscard]] Gain of(const std::vector<double>& torque_nm) const;
  [[nodiscard]] Gain of(const std::vector<double>& first_nm, const std::vector<double>& second_nm) const;

  /// Frequencies in Hz of the three strongest lines of what is left, at least a few lines apart.
  [[nodiscard]] std::array<double, 3> strongest_lines() const;

  /// What the model leaves, and its whitening.
  [[nodiscard]] const Spectrum& residual() const { return residual_; }
  [[nodiscard]] const Whittle::Whitened& whitened() const { return whitened_; }

 private:
  [[nodiscard]] Eigen::VectorXd cleaned(const std::vector<double>& torque_nm) const;

  const SpectralRecord& record_;
  Spectrum residual_;  // filled on the way to response_, so declared before it
  Response response_;
  Eigen::VectorXd density_;
  Whittle::Whitened whitened_;
  Projection projection_;  // takes out what the free numbers could explain
  Eigen::VectorXd left_;
};

/// A start's values with the factors of its torque put in; `scaled_by` as in its Starts.
[[nodiscard]] std::vector<double> scaled(const Hypothesis& hypothesis, int scaled_by, std::vector<double> values,
                                         const LinearScan::Gain& gain);

/// A point to start from, with the effects already there and the scan around it.
struct SearchOrigin {
  LinearScan scan;
  Point from;
  Record acted;  ///< with what the parts already there add to its torque: what another one is looked for in
  std::vector<Spectrum> slopes{};  ///< of the residual, of each number of the model
};

/// A point that a search may begin from, and what a linear scan says it explains.
struct StartingPoint {
  double nats = 0;
  Point at;                                 ///< its effect behind those already there
  int scaled = Hypothesis::kScalesNothing;  ///< as in the hypothesis' Starts
};

/// What a search needs to know beside its hypothesis.
struct SearchSetting {
  const SpectralRecord& record;
  const Whittle& whittle;
  /// Around the simulation's own J, B and C and around the refitted ones: the first are near where an effect is the
  /// cause, but nobody knows, and the second make up for the effect as well as they can, which may be far from where it
  /// is found.
  std::vector<StartingPoint> starts;
  Parts parts;  ///< effects already there
  WheelArm sim;
  Whittle::Roles roles;
  SlowTorque slow = SlowTorque::kFloor;
  Spectrum offset{};  ///< of the model (gap/model/spectral_model.hpp)
  /// How J, B, C and the values of the parts already there are fitted; empty: all of them are free.
  std::vector<Fitted> present{};
};

/// The most promising ones of a hypothesis around one origin, the best first. One that changes the response has no
/// torque to be scanned: all of its starts, with 0 nats.
[[nodiscard]] std::vector<StartingPoint> starting_points(const Hypothesis& hypothesis, const SpectralRecord& record,
                                                         const SearchOrigin& origin);

/// The best fit of a hypothesis, on top of the parts already there, over its starting values.
[[nodiscard]] Whittle::Fit search(const Hypothesis& hypothesis, const SearchSetting& setting);

/// The point with an effect behind the others.
[[nodiscard]] Point with_added(Point at, const Hypothesis& hypothesis, std::vector<double> values);

/// The record with the torques of the effects, on the measured motion, added to the driver's.
[[nodiscard]] Record with_torques_of(const Point& at, const SpectralRecord& record);

}  // namespace steerid::gap
