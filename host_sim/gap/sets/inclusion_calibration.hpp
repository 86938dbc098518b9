// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How probable a change is. Written by scripts/calibrate_inclusion.py; what it was fitted to and how reliable it is:
// docs/results/inclusion_calibration.md.
#pragma once

namespace steerid::gap {

/// Weights of the logistic functions of gap/sets/inclusion.cpp, and the shares of nats that stand in them.
struct InclusionCalibration {
  double changed;    ///< constant of a change
  double ratio;      ///< of the log of nats gained over other nats
  double shift;      ///< of how far J, B and C moved
  double unchanged;  ///< constant of no change
  double of_left;    ///< of nats that are left
  double of_gap;     ///< of nats that all changes gain
};

/// 989 questions.
inline constexpr InclusionCalibration kInclusionCalibration = {-2.706, 1.647, -0.7154, 6.985, 0.1, 0.001};

}  // namespace steerid::gap
