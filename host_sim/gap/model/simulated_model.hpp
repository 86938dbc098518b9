// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A simulation as a model of the record's Fourier lines: measured angle minus free run. x = J, B, C and the effects'
// values, one after the other. Exact where gap/model/spectral_model.hpp is an approximation on the measured motion, and
// some fifty times dearer. Noise passes the wheel with the effects as far as they are linear
// (gap/model/parts_response.hpp).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "gap/model/restarted_run.hpp"
#include "gap/model/slow_course.hpp"
#include "gap/model/spectral_model.hpp"

namespace steerid::gap {

class SimulatedModel final : public ResidualModel {
 public:
  /// A slow torque of a known course acts, too, which follows x where it is one that does. Several points are run on so
  /// many threads (0: one a core).
  SimulatedModel(const SpectralRecord& record, Parts parts, std::shared_ptr<const SlowCourse> slow = nullptr,
                 unsigned threads = 1);

  void evaluate(const Eigen::VectorXd& x, Spectrum& residual, Response& response) override;
  [[nodiscard]] std::vector<Spectrum> residuals_at(std::span<const Eigen::VectorXd> points) override;

  /// One angle a sample, rad (NaN where no stretch runs); empty where the run diverges. Valid until the next.
  [[nodiscard]] std::span<const double> run(const Point& at);

 private:
  [[nodiscard]] std::span<const double> run_with(const Point& at, const SlowCourse& slow);
  [[nodiscard]] Spectrum residual_at(const Point& at);

  const SpectralRecord& record_;
  Parts parts_;
  std::shared_ptr<const SlowCourse> slow_;
  unsigned threads_;
  RestartedRun run_;
  std::vector<std::unique_ptr<SimulatedModel>> others_;  // one a further thread
  double fastest_rad_s_ = 0;                             // that the wheel was
};

}  // namespace steerid::gap
