#include "gap/block_spectra.hpp"

#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace steerid {

BlockSpectra::BlockSpectra(std::vector<Block> blocks, double rate_hz) {
  std::vector<double> omega;
  for (const Block& block : blocks) {
    const double step_hz = rate_hz / static_cast<double>(block.count);
    const auto count = std::min<Eigen::Index>(static_cast<Eigen::Index>(kHighest_hz / step_hz) + 1,
                                              static_cast<Eigen::Index>(block.count / 2));
    blocks_.push_back({block, static_cast<Eigen::Index>(omega.size()), count});
    for (Eigen::Index k = 0; k < count; ++k) {
      omega.push_back(2 * std::numbers::pi * step_hz * static_cast<double>(k));
    }
  }
  omega_ = Eigen::Map<const Eigen::VectorXd>(omega.data(), static_cast<Eigen::Index>(omega.size()));
}

Spectrum BlockSpectra::of(std::span<const double> signal) const {
  Spectrum out(bins());
  thread_local Eigen::FFT<double> transform;  // keeps its tables
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  Eigen::VectorXd time;
  Eigen::VectorXcd lines;
  for (const Bins& bins : blocks_) {
    time = Eigen::Map<const Eigen::VectorXd>(signal.data() + bins.block.first,
                                             static_cast<Eigen::Index>(bins.block.count));
    transform.fwd(lines, time);
    out.segment(bins.first, bins.count) = lines.head(bins.count) / std::sqrt(static_cast<double>(bins.block.count));
  }
  return out;
}

}  // namespace steerid
