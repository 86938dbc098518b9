// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A record made ready for a diagnosis: at 100 Hz, split, its own defects found and repaired, a first linear fit and the
// noise read off.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gap/likelihood/noise_floor.hpp"
#include "gap/likelihood/whittle.hpp"
#include "gap/model/spectral_model.hpp"
#include "gap/preparation/known_torque.hpp"
#include "gap/preparation/prediction_remainder.hpp"
#include "gap/preparation/record_defects.hpp"
#include "log/angle_clock.hpp"
#include "plant/simulation.hpp"

namespace steerid::gap {

struct PreparedRecord {
  /// Throws BadInput where gap/preparation/record_gates.hpp does. `turn`: of the split
  /// (gap/likelihood/held_out_split.hpp).
  /// `origin_s`: the stamp of the log that effects take as time zero; its first one unless given.
  /// `clock`: the angle's, against the torques'.
  PreparedRecord(const Record& log, const Simulation& simulation, const std::vector<std::string>& without,
                 std::size_t turn = 0, const std::optional<double>& origin_s = {},
                 const PredictionRemainder& remainder = {}, const AngleClock& clock = {});
  PreparedRecord(const PreparedRecord&) = delete;
  PreparedRecord& operator=(const PreparedRecord&) = delete;

  /// Of a coarse angle: the floor has the rounding's error as a simulation's run makes it, one angle a sample, and the
  /// motion is what that run says of it between the steps. Of a record that has `coarse_quantization`.
  void round_as(std::span<const double> run_rad);

  /// The angle was found to be recorded late: whether the torque drives or answers is asked again. False where that
  /// changes nothing; else fewer lines are compared, and what was rounded is rounded as at first.
  bool look_again(const Simulation& simulation, double late_s);

  /// Of a floor that is known from above only.
  void lower_torque_noise(double factor);

  /// What a driver's own torque has above 1 Hz is noise for every set of changes from here on.
  void count_as_noise(const FastTorque& torque);

  /// One angle a sample: a simulation's runs over the stretches, without what is slower than anything in the record.
  [[nodiscard]] std::vector<double> run(const Simulation& simulation) const;

  /// Of the record, on the log's clock.
  [[nodiscard]] std::vector<double> log_stamps_s() const;

  double origin_s;                    ///< the stamp of the log that effects take as time zero
  double message_told_to_s = 0;       ///< as the log's reading says (log/resample.hpp)
  Record record;                      ///< at 100 Hz, as it was recorded but for remainder_rad; stamps since the origin
  std::vector<double> remainder_rad;  ///< what is taken off the measured angle (prediction_remainder.hpp)
  RecordDefects defects;              ///< of it
  KnownTorque known;                  ///< the repaired record's: what hypotheses are driven with
  std::vector<Block> blocks;          ///< all three parts
  /// Above 0 a driver steers: record and repaired record are without what is slower (gap/preparation/steered_band.hpp).
  double lowest_hz = 0;
  std::vector<std::string> untold;    ///< effects that cannot be told then
  bool drifts = false;                ///< no spring brings the wheel back: free runs begin anew at every block
  std::vector<RunStretch> stretches;  ///< in which the simulations run that are reported
  /// The linear wheel fitted without the held-out part, within a factor of four of the simulation's.
  WheelArm refit;
  WheelArm closest;  ///< the linear wheel whose free run comes closest, whatever the residual's colour
  std::unique_ptr<SpectralRecord> spectral;  ///< of the repaired record, the held-out part left out
  std::unique_ptr<Whittle> whittle;
  std::vector<std::string> notes;

 private:
  void take_off(const PredictionRemainder& remainder);
  void take_off_steering(double below_hz, const Simulation& simulation);
  void compare_up_to(const Simulation& simulation, double highest_hz, NoiseFloor floor);
  void take(const NoiseFloor& floor);

  double pass_hz_ = kAllPassed_hz;  ///< what is faster was filtered away by the resampling
  double highest_hz_ = kHighest_hz;
};

}  // namespace steerid::gap
