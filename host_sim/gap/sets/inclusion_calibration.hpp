// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How probable a change is. Written by scripts/calibrate_inclusion.py; what it was fitted to and how reliable it is:
// docs/results/inclusion_calibration.md.
#pragma once

namespace steerid {

/// Weights of the logistic functions of gap/sets/inclusion.cpp.
struct InclusionCalibration {
  double changed;    ///< constant of a change
  double ratio;      ///< of the log of nats gained over nats left
  double shift;      ///< of how far J, B and C moved
  double unchanged;  ///< constant of no change
};

inline constexpr InclusionCalibration kInclusionCalibration = {-0.05, 1.12, -0.52, 6};

}  // namespace steerid
