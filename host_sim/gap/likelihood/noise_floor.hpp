// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What would be left between simulation and record if the simulation were right: the floor, as a power density.
//
//   S(f) = v_angle + |H(f)|^2 (v_torque + v_slow p(f) + fast(f))
//
// Four independent sources, H the response of angle to torque:
//   angle    white noise of the angle sensor, v_angle per sample
//   torque   white noise of the torque sensors; the model is driven with it, the wheel was not
//   slow     the driver's own torque that no sensor sees, of mean square v_slow and density
//              p(f) = 4/(pi f0) / (1 + (f/f0)^2)^2
//            up to some 1.3 Hz, where it ends: what is faster is no slow torque. It is some 1 to 2 % of
//            the applied torque in most records: part of the floor, and no cause.
//   fast     what he adds above it (gap/likelihood/fast_torque.hpp), as one set's rest says it for all
//
// The two white levels are read off the channels themselves at frequencies where no wheel moves (several bands from 15
// Hz up), so they do not depend on any model: a missing effect cannot pass for noise. The lowest band counts, unless
// they lie on a line over cos w, as those of noise with a memory of one sample do: then what the line has at zero.
// Where a machine is driven even there (a stiff position loop), the channels hold real torque and motion: what T -
// angle/H leaves at the same frequencies bounds the torque's level, H T - angle the angle's. Both are sums in which the
// other sensor's noise stands too, so that they can only be too high, and the lower one counts. Only v_slow is fitted,
// with a prior that keeps it a small share of the applied torque unless the hypothesis is that it is large.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "gap/likelihood/block_spectra.hpp"
#include "gap/likelihood/fast_part.hpp"
#include "gap/likelihood/fast_torque.hpp"
#include "log/record.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid::gap {

inline constexpr double kAllPassed_hz = 1e9;

/// The density of a slow torque of unit power, over frequency: that of low-passed noise, which ends at some 1 Hz.
struct SlowColour {
  double corner_hz = 0.3;
  int order = 2;     ///< of the low pass
  bool ends = true;  ///< at some 1 Hz; else it is a power law, of unit power from the corner on

  [[nodiscard]] double density(double f_hz) const;  ///< 1/Hz; its integral is one
  [[nodiscard]] Eigen::ArrayXd density(const Eigen::ArrayXd& f_hz) const;
  /// Mean square of its derivative, 1/s^2.
  [[nodiscard]] double rate_variance() const;
};

struct NoiseFloor {
  double angle_variance = 0;
  double torque_variance = 0;
  double slow_variance = 0;
  SlowColour slow_colour;
  FastTorque fast;
  /// Torque and angle are coherent where the levels are read off (gap/preparation/driven_band.hpp), as where a loop
  /// answers the angle's noise: the torque's level holds the answers, and is too high by nobody knows how much.
  bool at_most = false;
  double lowest_hz = 0;         ///< above 0: a driver steers, and what is slower is in no channel
                                ///< (gap/preparation/steered_band.hpp)
  double steering_tail_nm = 0;  ///< then: rms of what his own torque has beyond it, as far as that is known before

  /// Reads the white levels off a record at 100 Hz; slow_variance stays 0. `wheel` is the best linear one.
  /// `pass_hz`: what is faster was filtered away when the record was resampled.
  static NoiseFloor of(const Record& record, const WheelArm& wheel, double pass_hz = kAllPassed_hz);

  /// Whether the record holds what is at this frequency, up to the filter's half power.
  [[nodiscard]] bool holds(double f_hz) const { return f_hz >= lowest_hz - kTransition_hz / 2; }
  /// Where the slow torque ends, Hz.
  [[nodiscard]] double slow_top_hz() const;
  /// Of the torque that no sensor sees, per sample: white noise of variance v has the density v here.
  [[nodiscard]] Eigen::ArrayXd unmeasured_density(const Eigen::ArrayXd& f_hz) const;
  [[nodiscard]] double unmeasured_density(double f_hz) const;
  /// The same with the torque sensors' noise.
  [[nodiscard]] double torque_density(double f_hz) const { return torque_variance + unmeasured_density(f_hz); }
  /// S at the bins from `first` on, one a value of `gain`, which holds |H|^2.
  [[nodiscard]] Eigen::VectorXd density(const BlockSpectra& spectra, const Eigen::VectorXd& gain,
                                        Eigen::Index first = 0) const;
  /// The same with the torque's noise passed by spectra.counted_gain(): the part of S that log S counts.
  [[nodiscard]] Eigen::VectorXd counted_density(const BlockSpectra& spectra, const Eigen::VectorXd& gain,
                                                Eigen::Index first = 0) const;
  /// What the angle's channel has of it at a bin.
  [[nodiscard]] double angle_density(const BlockSpectra& spectra, Eigen::Index bin) const {
    const double rebuilt = spectra.angle_noise_gain().size() > 0 ? spectra.angle_noise_gain()[bin] : 1;
    return std::max(angle_variance * rebuilt, spectra.rounding().size() > 0 ? spectra.rounding()[bin] : 0);
  }
  /// And the torque sensors'.
  [[nodiscard]] double torque_density(const BlockSpectra& spectra, Eigen::Index bin) const {
    return spectra.torque_noise_share().size() > 0 ? torque_variance * spectra.torque_noise_share()[bin]
                                                   : torque_variance;
  }

 private:
  [[nodiscard]] Eigen::VectorXd density(const BlockSpectra& spectra, const Eigen::VectorXd& gain,
                                        const Eigen::VectorXd& sensor_gain, Eigen::Index first) const;
};

/// Variance of the white noise on one channel of a record at 100 Hz, read off the channel alone.
[[nodiscard]] double white_noise_variance(const std::vector<double>& channel, const Record& record,
                                          double pass_hz = kAllPassed_hz);

}  // namespace steerid::gap
