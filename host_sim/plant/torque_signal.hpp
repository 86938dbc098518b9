// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The torque between its samples, made explicit: a record holds numbers at instants, a wheel integrates a function of
// time, and what is assumed in between decides how much delay and bias an identified model inherits.
//
//   kBandLimited  the samples were taken from a smooth signal (an anti-alias filter stood before them). The signal is
//                 rebuilt by the interpolating cubic spline through all samples, with not-a-knot ends. It has no phase
//                 error at all; its amplitude error for a sine of frequency f sampled at fs is close to
//                 (2 pi f/fs)^4/720. Measured at fs = 100 Hz: 1.4e-5 at 5 Hz, 2.4e-4 at 10 Hz. Straight lines between
//                 the samples would err by (2 pi f/fs)^2/12, 8e-3 at 5 Hz.
//   kHeld         each sample is held until the next one arrives. Right when the EPS really does hold its target
//                 torque; wrong for a sampled measurement, where it invents a delay of half a sample.
//
// Either way the torque is a cubic polynomial on every interval between samples, which plant/linear_response.hpp
// integrates exactly. Before the first and after the last sample the end values are held.
//
// Times may be unequally spaced. Building costs O(n); at() is O(1) for nearly equal spacing, O(log n) otherwise.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "plant/cubic.hpp"

namespace steerid {

/// In Nm.
using TorqueCubic = Cubic;

class TorqueSignal {
 public:
  enum class Between {
    kBandLimited,  ///< a cubic spline through the samples
    kHeld,         ///< every sample holds until the next
  };

  /// `time_s` strictly increasing, as long as `torque_nm`, not empty; throws std::invalid_argument otherwise.
  static TorqueSignal from_samples(std::span<const double> time_s, std::span<const double> torque_nm, Between between);

  [[nodiscard]] double at(double time_s) const;

  /// Intervals between samples: one fewer than samples.
  [[nodiscard]] std::size_t pieces() const { return time_s_.size() - 1; }
  /// Piece k, valid from knot_s(k) to knot_s(k + 1).
  [[nodiscard]] Cubic piece(std::size_t k) const { return cubic_[k]; }
  /// Time of sample k, 0 <= k <= pieces().
  [[nodiscard]] double knot_s(std::size_t k) const { return time_s_[k]; }
  [[nodiscard]] std::span<const double> knots_s() const { return time_s_; }

  /// The torque as a polynomial whose origin is `time_s`, and the time until which it holds (infinity past the end).
  struct Local {
    Cubic cubic;
    double until_s = 0;
  };
  [[nodiscard]] Local local(double time_s) const;

 private:
  TorqueSignal() = default;
  [[nodiscard]] std::size_t piece_holding(double time_s) const;

  std::vector<double> time_s_;
  std::vector<Cubic> cubic_;  // one a sample; the last one is the constant that holds after the end
};

}  // namespace steerid
