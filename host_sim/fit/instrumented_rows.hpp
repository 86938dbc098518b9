// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A record of a wheel whose driver nobody measures, as rows of a regression with an instrument.
//
//   torque = J th'' + B th' + C th + constant + v
//
//   torque      the known torque on what is identified (Record::net_torque_nm): minus the bar, or minus the rim
//   v           the driver's own torque and the sensors' noise; it has moved the wheel, too, and stands in th as well
//   source      what has moved the wheel and does not know the driver: the probe; without one, or where the driver's
//   own
//               torque is measured, the torque itself
//   w_1 .. w_n  Laguerre functions of the source: its motion is a sum of them, whatever lies below the bar (Wahlberg
//               1991, IEEE Trans. Automatic Control 36)
//
// The source counts about its mean and in its own deviation: its unit says nothing.
//
// All of it passes one Gaussian of 20 ms (6.6 Hz at 3 dB), by which value, rate and acceleration come from the same
// samples; one row in four is kept, which leaves 25 a second. What folds back is alike in torque and motion, and spoils
// no equation between them.
//
// The instrument of a row is the motion that the source has caused there. How much of each function is in it is learned
// from all other parts of the record, never from the row's own: the noise of the row is then not in its instrument, and
// the estimate has no bias of short records (Angrist, Imbens and Krueger 1999, J. Applied Econometrics 14, jackknife
// instrumental variables; here by blocks of 3 s, since the noise is coloured).
//
// What the source did before a stretch is not in the record, so that each gives its first 1.2 s to the functions.
//
// Record at 100 Hz; stretches between gaps that then leave fewer than 20 rows, 2.1 s, are left out. Cost: 4 us a
// sample.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

#include "fit/autoregression.hpp"
#include "log/record.hpp"

namespace steerid {

/// Whether a probe is in the record that changes by more than rounding, in whatever unit and about whatever mean.
/// Whether it has driven anything is for what it drives to tell: drives(probe_misfit()).
[[nodiscard]] bool has_a_probe(const Record& record);

class InstrumentedRows {
 public:
  static constexpr double kRowsPerS = 25;
  static constexpr Eigen::Index kFunctions = 8;
  static constexpr int kUnknowns = 4;  ///< J, B, C, constant

  /// `record` is at 100 Hz; its torque is net_torque_nm().
  explicit InstrumentedRows(const Record& record);

  [[nodiscard]] bool by_probe() const { return by_probe_; }
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(time_s_.size()); }
  /// Of each row.
  [[nodiscard]] const std::vector<double>& time_s() const { return time_s_; }
  /// Mean square of the torque about its mean below 2 Hz, where drivers act, Nm^2.
  [[nodiscard]] double slow_torque_power() const;
  /// The same of what J, B, C and the constant leave of it.
  [[nodiscard]] double slow_unexplained_power(const Eigen::Vector4d& parameters) const;
  /// That itself, Nm, one value a row that the low pass covers; the stretches one after the other.
  [[nodiscard]] std::vector<double> slow_unexplained(const Eigen::Vector4d& parameters) const;

  /// What J, B, C and the constant leave of the torque, a gap-free stretch each.
  [[nodiscard]] std::vector<Eigen::VectorXd> unexplained(const Eigen::Vector4d& parameters) const;
  /// Likewise of an arm that changes, with its numbers at each row.
  [[nodiscard]] std::vector<Eigen::VectorXd> unexplained(std::span<const Eigen::Vector4d> parameters) const;

  /// Every row behind the filter that makes v white.
  struct White {
    Eigen::VectorXd torque;
    Eigen::Matrix<double, Eigen::Dynamic, kUnknowns> motion;      ///< th'', th', th, 1
    Eigen::Matrix<double, Eigen::Dynamic, kUnknowns> instrument;  ///< of them, what the source has caused; 1 its own
    /// (th - its mean)^2, and its instrument: (th - its mean) times what the source has caused of th. A torque that the
    /// driver adds is odd in what he turns and that product even, so that the one says nothing of the other.
    Eigen::VectorXd square;
    Eigen::VectorXd square_instrument;
    /// Torque, th'', th', th as far as the source has caused them, learned from the whole record.
    Eigen::Matrix<double, Eigen::Dynamic, 4> driven;
  };
  /// What the source causes of the motion is learned from parts `memory_s` around, which weigh less the farther they
  /// are (e-fold); without it from the whole record.
  [[nodiscard]] White whitened(const Autoregression& noise,
                               double memory_s = std::numeric_limits<double>::infinity()) const;

 private:
  static constexpr Eigen::Index kTorque = 0, kMotion = 1, kConstant = 4, kSquare = 5, kSource = 6;
  static constexpr Eigen::Index kTimesAngle = kSource + 3 * kFunctions;
  static constexpr Eigen::Index kColumns = kTimesAngle + kFunctions;

  bool by_probe_ = false;
  std::vector<Eigen::MatrixXd> stretches_;  ///< torque; th'', th', th; 1; th^2; three of each function; each times th
  std::vector<double> time_s_;
};

}  // namespace steerid
