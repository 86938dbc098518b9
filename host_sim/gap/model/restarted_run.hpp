// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Free runs over a record that begin anew where they have to.
//
// A free run shows what a simulation is worth as long as the wheel forgets where it began. Two things end that:
//   - a gap in the record: nobody knows what the wheel did meanwhile
//   - a wheel without a spring that matters: every small torque adds up for good (a motor alone, a linear drive). It
//     begins anew at every block of the split.
// Each simulation begins where it is nearest to what is recorded next: an angle that is recorded late is not where the
// wheel is.
// Samples that no stretch covers have no simulated angle: NaN. A record's stamps are seconds since the time zero of the
// effects.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "gap/likelihood/held_out_split.hpp"
#include "plant/free_run.hpp"
#include "plant/simulation.hpp"

namespace steerid::gap {

/// A stretch of a record that is run in one go.
struct RunStretch {
  std::size_t first = 0;
  std::size_t count = 0;
  std::optional<WheelState> initial{};  ///< where none is given it is estimated
  double begin_s = 1.0;                 ///< from so much of the beginning
};

/// How long a wheel remembers where it began: the slower of its two time constants, s. Infinite without a spring.
[[nodiscard]] double memory_s(const WheelArm& wheel);

/// The wheel with the spring that would let a constant torque move it as far, rms, as it does within a run of `run_s`:
/// for J alone T t^2/2J, for B alone T t/B, whose rms over a run are T t^2/sqrt(20)/J and T t/sqrt(3)/B.
[[nodiscard]] WheelArm within_run(const WheelArm& wheel, double run_s);

/// The stretches that cover `blocks`, in order of time. `anew_each_block`: for a wheel that does not come back.
[[nodiscard]] std::vector<RunStretch> run_stretches(const Record& record, const std::vector<Block>& blocks,
                                                    bool anew_each_block);

class RestartedRun {
 public:
  /// `record` must outlive this.
  RestartedRun(const Record& record, std::vector<RunStretch> stretches, TorqueSignal::Between between);

  /// One angle a sample of the record, rad; valid until the next run.
  std::span<const double> operator()(const WheelArm& wheel, std::span<const Effect> effects);

  /// Every further run begins where the last one did.
  void keep_starts();
  /// The stretches, with the states in which they begin where those are given or kept.
  [[nodiscard]] std::vector<RunStretch> stretches() const;

  /// Whether the last run stayed finite to the end of every stretch.
  [[nodiscard]] bool finite() const { return finite_; }

 private:
  struct Part {
    RunStretch stretch;
    Record record;
    std::unique_ptr<FreeRun> run;
  };
  std::vector<Part> parts_;
  std::vector<double> angle_rad_;
  bool finite_ = true;
};

/// Whether a simulated wheel forgets where it began: of two runs over the stretches, the second of which begins an
/// angle's thousandth further, the second ends no further from the first in any of them. A wheel that does not is held
/// by whoever turns it, if at all.
[[nodiscard]] bool holds_itself(const Record& record, const std::vector<RunStretch>& stretches, const WheelArm& wheel,
                                std::span<const Effect> effects, TorqueSignal::Between between);

/// One such run of a whole simulation.
[[nodiscard]] std::vector<double> restarted_run(const Simulation& simulation, const Record& record,
                                                const std::vector<RunStretch>& stretches);

}  // namespace steerid::gap
