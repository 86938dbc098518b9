// The Fourier transforms of a record's blocks, side by side: the ground on which hypotheses are compared.
//
// X_k = sum_n x_n exp(-i 2 pi k n/N) / sqrt(N), so that white noise of variance v has E|X_k|^2 = v. Bins run from zero
// to kHighest_hz. A block is no period of anything: what leaks from its two ends, for a linear system of any order, is
// a polynomial in i w on the torque's side (Pintelon and Schoukens, System Identification, 2012, section 6.3.2). Its
// kEnds real coefficients are free in every block and projected out, which also sets the block free of the state it
// begins with.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "gap/held_out_split.hpp"

namespace steerid {

inline constexpr double kHighest_hz = 12.0;
inline constexpr int kEnds = 6;

using Spectrum = Eigen::VectorXcd;

class BlockSpectra {
 public:
  BlockSpectra(std::vector<Block> blocks, double rate_hz);

  struct Bins {
    Block block;
    Eigen::Index first = 0;
    Eigen::Index count = 0;
  };
  [[nodiscard]] const std::vector<Bins>& blocks() const { return blocks_; }
  [[nodiscard]] Eigen::Index bins() const { return omega_.size(); }
  /// rad/s, one a bin.
  [[nodiscard]] const Eigen::VectorXd& omega() const { return omega_; }

  /// The transform of a signal that has one value a sample of the record.
  [[nodiscard]] Spectrum of(std::span<const double> signal) const;

 private:
  std::vector<Bins> blocks_;
  Eigen::VectorXd omega_;
};

}  // namespace steerid
