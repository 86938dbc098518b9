// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A free run: the angle that a simulated wheel takes under a record's torques alone, to lay beside the recorded angle.
// Made for fits by output error, which repeat it thousands of times on one record with other parameters: torques are
// interpolated once, buffers are kept, and only the handful of effect objects is made anew in a run.
//
// A run goes: recorded torques, corrected by the record effects (offset, drift, clipping) -> plant -> angle, passed
// through the record effects (delay, lag, resolution, loss) -> predicted angle.
//
// A record that starts in the middle of a drive does not tell its initial angle and rate. Unless they are given they
// are estimated: Gauss-Newton on both, least squares of recorded minus predicted angle over the first `stretch_s` of
// the record (default 1 s), which costs about a tenth of a run at 100 s. A normal prior as wide as the record's own
// rates keeps the rate of a run that misses the record by other causes. Samples of the record that are not finite are
// left out. Memory of older motion inside effects (hysteresis, reflex, lag) starts settled, as if the wheel had been
// turned from zero and held.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "log/record.hpp"
#include "plant/effects/effect.hpp"
#include "plant/linear_response.hpp"
#include "plant/plant.hpp"
#include "plant/torque_signal.hpp"

namespace steerid {

class FreeRun {
 public:
  struct Options {
    TorqueSignal::Between between = TorqueSignal::Between::kBandLimited;
    /// The stamp that effects take as time zero; the record's first stamp unless given. A run over the later part of a
    /// record needs the origin of the whole.
    std::optional<double> origin_s{};
    double stretch_s = 1.0;  ///< used to estimate the initial state
  };

  /// `record` must outlive this; throws std::invalid_argument when it is empty or its times do not increase.
  explicit FreeRun(const Record& record, Options options);
  explicit FreeRun(const Record& record) : FreeRun(record, Options{}) {}

  /// The predicted angle, one value a sample of the record, valid until the next run. `initial` is the wheel's state at
  /// the first sample (with a delay, one reach of the delay before it). Where the run diverges the angle is not a
  /// number. Throws BadInput when the effects contradict each other.
  std::span<const double> operator()(const WheelArm& wheel, std::span<const Effect> effects = {},
                                     const std::optional<WheelState>& initial = std::nullopt);

  /// The initial state of the last run, given or estimated.
  [[nodiscard]] const WheelState& initial() const { return initial_; }

  /// Divides the integration steps further, see Plant::refine().
  void refine(int factor) { refinement_ = factor; }

 private:
  using RecordEffects = std::vector<std::unique_ptr<RecordEffect>>;

  void interpolate(std::span<const double> driver_nm, std::span<const double> motor_nm);
  void prepare_torque(const RecordEffects& effects);
  void prepare_time(double reach_s);
  [[nodiscard]] std::size_t node(std::size_t sample) const { return sample + first_; }
  void run_plant(Plant& plant, const WheelState& from, std::size_t nodes);
  void pass_record(const RecordEffects& effects, std::size_t nodes, bool converters);
  double misfit(Plant& plant, const RecordEffects& effects, const WheelState& from);
  [[nodiscard]] WheelState estimate_initial(Plant& plant, const RecordEffects& effects);
  /// Of the whole record, over samples that are `apart` from each other.
  [[nodiscard]] double mean_square_rate(std::size_t apart) const;

  const Record& record_;
  Options options_;
  int refinement_ = 1;
  WheelState initial_;

  std::vector<double> sample_s_;  // the record's stamps since the origin
  std::vector<Cubic> driver_;
  std::vector<Cubic> motor_;
  bool repaired_ = false;  // the cubics are those of repaired torques
  std::vector<double> correction_nm_;
  bool corrected_ = false;
  std::vector<double> repaired_driver_;
  std::vector<double> repaired_motor_;

  // Nodes of the run: the samples, with some before and after where a delay reaches beyond the record.
  std::size_t first_ = 0;  // node of the first sample
  std::vector<double> time_s_;
  std::vector<double> angle_rad_;
  std::vector<double> rate_rad_s_;
  std::size_t stretch_ = 0;  // samples of the first stretch
  std::vector<double> residual_;
  std::vector<double> base_;
  std::vector<double> by_angle_;
};

}  // namespace steerid
