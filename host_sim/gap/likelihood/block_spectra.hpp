// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The Fourier transforms of a record's blocks, side by side: the ground on which hypotheses are compared.
//
// X_k = sum_n x_n exp(-i 2 pi k n/N) / sqrt(N), so that white noise of variance v has E|X_k|^2 = v. Bins run from zero
// to kHighest_hz, or from further up (gap/preparation/steered_band.hpp) or to less (gap/preparation/driven_band.hpp)
// where a record does not speak of the wheel so far. A
// block is no period of anything: what leaks from its two ends, for a linear system of any order, is a polynomial in i
// w on the torque's side (Pintelon and Schoukens, System Identification, 2012, section 6.3.2). Its kEnds real
// coefficients are free in every block and projected out, which also sets the block free of the state it begins with;
// two more where a driver steers (gap/likelihood/whitened.cpp).
#pragma once

#include <Eigen/Core>
#include <complex>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "gap/likelihood/held_out_split.hpp"
#include "log/resample.hpp"

namespace steerid::gap {

inline constexpr double kHighest_hz = 12.0;
inline constexpr int kEnds = 6;

using Spectrum = Eigen::VectorXcd;

/// What holding a sample until the next makes of a signal at a frequency that turns by so much a sample, rad: a sinc,
/// half a sample late.
[[nodiscard]] std::complex<double> zero_order_hold(double turn);

class BlockSpectra {
 public:
  explicit BlockSpectra(std::vector<Block> blocks, double highest_hz = kHighest_hz, double lowest_hz = 0);

  struct Bins {
    Block block;
    Eigen::Index first = 0;
    Eigen::Index count = 0;
    Eigen::Index below = 0;     ///< lines from zero on that are left out
    Eigen::MatrixXcd hidden{};  ///< see hide()
  };
  [[nodiscard]] const std::vector<Bins>& blocks() const { return blocks_; }
  [[nodiscard]] Eigen::Index bins() const { return omega_.size(); }
  /// Between two lines of a block.
  [[nodiscard]] double line_step_rad_s(const Bins& bins) const {
    return 2 * std::numbers::pi * kResampledRateHz / static_cast<double>(bins.block.count);
  }
  /// rad/s, one a bin.
  [[nodiscard]] const Eigen::VectorXd& omega() const { return omega_; }

  /// The transform of a signal that has one value a sample of the record.
  [[nodiscard]] Spectrum of(std::span<const double> signal) const;

  /// Samples from `first` on of the applied torque are uncertain: by independent shapes, one a column, each of the size
  /// of its standard deviation. Their transforms stand in the blocks' `hidden`, one a column. `held`: torques hold
  /// between samples.
  void hide(std::size_t first, const Eigen::MatrixXd& shapes, bool held);

  /// Hidden shapes become as few as say the same where a line counts with `weight`, one a bin: those that add less than
  /// `least` to the sum over its lines are left out.
  void condense_hidden(const Eigen::VectorXd& weight, double least);

  /// The angle was rounded to steps: the power of its error, one value a bin (gap/likelihood/rounding_spectrum.hpp).
  void round(double step_rad, Eigen::VectorXd power) {
    step_rad_ = step_rad;
    rounding_ = std::move(power);
  }
  /// Lost samples of the angle were rebuilt: the density of its noise over that of the kept ones', one value a bin
  /// (gap/preparation/lost_samples.hpp).
  void rebuild(Eigen::VectorXd noise_gain) { angle_noise_gain_ = std::move(noise_gain); }
  /// Empty where none were.
  [[nodiscard]] const Eigen::VectorXd& angle_noise_gain() const { return angle_noise_gain_; }
  /// Of the torque's noise not all is left: this share of its power, one value a bin
  /// (gap/preparation/known_torque.hpp).
  void leave_of_torque_noise(Eigen::VectorXd share) { torque_noise_share_ = std::move(share); }
  /// Empty where all is.
  [[nodiscard]] const Eigen::VectorXd& torque_noise_share() const { return torque_noise_share_; }
  /// The power that a wheel near the right one passes from torque to angle, one value a bin: what the torque's noise is
  /// counted with where hypotheses are told apart (gap/likelihood/whittle.hpp).
  void count_torque_noise_by(Eigen::VectorXd gain) { counted_gain_ = std::move(gain); }
  /// Empty: by each hypothesis' own.
  [[nodiscard]] const Eigen::VectorXd& counted_gain() const { return counted_gain_; }
  [[nodiscard]] double step_rad() const { return step_rad_; }  ///< 0 where it was not
  /// Empty where it was not.
  [[nodiscard]] const Eigen::VectorXd& rounding() const { return rounding_; }

 private:
  std::vector<Bins> blocks_;
  Eigen::VectorXd rounding_;
  Eigen::VectorXd angle_noise_gain_;
  Eigen::VectorXd torque_noise_share_;
  Eigen::VectorXd counted_gain_;
  double step_rad_ = 0;
  Eigen::VectorXd omega_;
};

}  // namespace steerid::gap
