// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Hypotheses as a model of the record's Fourier lines: measured angle minus H (torque + the effects' torques on the
// measured motion). See gap/hypotheses/hypothesis.hpp for what this leaves out.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "gap/likelihood/whittle.hpp"
#include "gap/model/point.hpp"
#include "gap/model/restarted_run.hpp"

namespace steerid::gap {

/// J, B and C of a fit are at most so many times larger or smaller than those that it begins with.
inline constexpr double kWheelWithin = 4;

/// What all hypotheses on one record share.
struct SpectralRecord {
  /// `anew`: free runs of the record begin anew at every block (gap/model/restarted_run.hpp). `highest_hz`,
  /// `lowest_hz`: of its lines.
  SpectralRecord(const Record& record, const WheelArm& wheel, std::vector<Block> blocks, bool held, bool anew = false,
                 double highest_hz = kHighest_hz, double lowest_hz = 0);

  const Record& record;
  MeasuredMotion motion;
  BlockSpectra spectra;
  Spectrum angle;
  std::vector<double> net_torque_nm;
  Spectrum torque;
  bool held = false;             ///< torques hold between samples
  bool anew_each_block = false;  ///< free runs begin anew at every block
  double lowest_hz = 0;          ///< above 0: record without what is slower (gap/likelihood/fast_part.hpp)
  double applied_rms_nm = 0;
  std::vector<RunStretch> stretches;  ///< in which simulations run

  /// The lines of a torque or of an angle that a model makes.
  [[nodiscard]] Spectrum made(std::span<const double> signal) const;

  [[nodiscard]] TorqueSignal::Between between() const {
    return held ? TorqueSignal::Between::kHeld : TorqueSignal::Between::kBandLimited;
  }

  /// The torque's spectrum as it was `samples` earlier (its end values hold beyond the record).
  [[nodiscard]] Spectrum torque_late_by(std::ptrdiff_t samples) const;
};

class SpectralModel final : public ResidualModel {
 public:
  /// Without parts it is the linear wheel alone. `offset` is added to the residual: what free runs are known to leave
  /// beyond this model at the point around which it is used.
  SpectralModel(const SpectralRecord& record, Parts parts, Spectrum offset = {});

  void evaluate(const Eigen::VectorXd& x, Spectrum& residual, Response& response) override;

 private:
  /// A part's torque and where it was worked out, in the numbers that it depends on. What it is linear in stands at one
  /// there, a phase at zero and, in `quarter`, at a quarter.
  struct Acted {
    std::vector<double> at;
    std::ptrdiff_t late = 0;  // samples
    Spectrum torque;
    Spectrum quarter;
  };
  Spectrum acted(std::size_t part, const Point& at, std::ptrdiff_t late);
  /// The same at `at`, worked out if it is not known.
  const Acted& known(std::size_t part, const WheelArm& wheel, std::ptrdiff_t late, std::vector<double> at);

  const SpectralRecord& record_;
  Parts parts_;
  Spectrum offset_;
  std::vector<double> torque_nm_;
  std::vector<std::vector<Acted>> acted_;  // of each part the last ones, the latest first
  std::ptrdiff_t shifted_by_ = 0;          // the whole samples for which shifted_ holds
  Spectrum shifted_;
};

/// J, B, C and the parameters of `parts` as a fit takes them. J, B and C stay within a factor of four of the
/// simulation's: on the measured motion a stiffer spring and an effect that undoes it would follow the
/// measurement wherever it goes. Limits, steps and priors of the others are the vocabulary's.
[[nodiscard]] std::vector<Fitted> fitted_parameters(const WheelArm& sim, const Parts& parts);

}  // namespace steerid::gap
