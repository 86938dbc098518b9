// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a torque that no sensor sees does to the likelihood of a record's lines: each has the density
//
//   S(f) = white(f) + |H(f)|^2 p(f)
//
// with p the torque's density, per sample (white noise of variance v has v), and white all that is known of the noise
// without it.
#pragma once

#include <Eigen/Core>

#include "gap/likelihood/whittle.hpp"

namespace steerid::gap {

/// One value a line.
struct TorqueLines {
  /// The lines of the blocks of `roles` up to `top_hz`. `left`: what the model leaves of every line of the spectra,
  /// without its blocks' ends; `known`: the part of a line that a hidden torque leaves. The floor's slow torque does
  /// not count.
  TorqueLines(const BlockSpectra& spectra, const Whittle::Roles& roles, NoiseFloor floor, const Response& response,
              const Eigen::VectorXd& left, const Eigen::VectorXd& known, double top_hz);

  /// Minus log likelihood with a torque of that density.
  [[nodiscard]] double cost(const Eigen::ArrayXd& torque_density) const;

  Eigen::ArrayXd f_hz;
  Eigen::ArrayXd white;   ///< the density without it
  Eigen::ArrayXd gain;    ///< |H|^2
  Eigen::ArrayXd power;   ///< what the model leaves there
  Eigen::ArrayXd weight;  ///< of a line in the sum
};

}  // namespace steerid::gap
