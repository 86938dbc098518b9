// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Drives of a whole column with the truth beside them, and what the flashed task makes of them.
//
// Two generators that share no code draw them, from different distributions:
//
//   drawn      the project's own column (backend/simulated_column.hpp), as docs/testing.md says
//   held_out   another column, driver, road and sensors (blind/column_drive.hpp); nothing may be tuned on it
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "backend/simulated_column.hpp"
#include "blind/column_drive.hpp"
#include "log/record.hpp"
#include "plant/wheel_arm.hpp"
#include "port/estimate.hpp"

namespace steerid {

/// What becomes of the arm in a drive of 60 s.
enum class ArmStory : std::uint8_t { kStays, kRamps, kSwings, kSecondHand, kHandsLeave };

inline constexpr std::array kAllArmStories = {ArmStory::kStays, ArmStory::kRamps, ArmStory::kSwings,
                                              ArmStory::kSecondHand, ArmStory::kHandsLeave};

/// As pages and files spell it.
[[nodiscard]] std::string_view name(ArmStory story);

/// What a drive is asked to be; the rest is drawn.
struct DriveRequest {
  ArmStory story = ArmStory::kStays;
  double steering_rad = 0.1;  ///< intended angle of the driver, rms; less where Tv would be more than 4 Nm rms
  double probe_nm = 1;        ///< rms
  double duration_s = 60;
  double wheel_friction_nm = 0;  ///< above the bar
};

struct LabelledDrive {
  Record record;                     ///< angle, torque_bar, torque_motor, torque_rim, probe
  std::vector<WheelArm> truth;       ///< above the bar, a value a row
  std::vector<double> voluntary_nm;  ///< Tv, likewise
  /// Of each kBlock rows (study/probe_bound.hpp): by the probe, or by the whole motion where all torque is known.
  std::vector<Eigen::Matrix3d> information;

  static constexpr std::size_t kBlock = 10;
};

/// Drive `number` of `seed`, the same whatever other drives are made.
[[nodiscard]] ColumnScenario drawn_scenario(const DriveRequest& request, std::uint64_t seed, std::uint64_t number);

/// What is measured.
enum class Known : std::uint8_t {
  kBarAndProbe,  ///< as in a car
  kAllTorque,    ///< the driver's voluntary torque as well (30 mNm of noise), and the bar's stands for the motor's
};

/// Whether what the drive lets know is worked out, at the price of two more simulations.
enum class Bound : std::uint8_t { kNone, kWithInformation };

/// Through the simulated column, without the task: no probe but the scenario's own.
[[nodiscard]] LabelledDrive drive_of(const ColumnScenario& scenario, Known known,
                                     Bound bound = Bound::kWithInformation);

/// As a laboratory has it: the driver's voluntary torque measured with 30 mNm of noise, all but `unseen` of it (a
/// share), and the bar's torque in place of the motor's.
void know_all_torque(LabelledDrive& drive, std::uint64_t seed, double unseen = 0);

/// Drive `number` of `seed` by the other generator, information included.
[[nodiscard]] LabelledDrive held_out_drive(const DriveRequest& request, std::uint64_t seed, std::uint64_t number);

/// A drive of the other generator with its truth; takes the record. No information.
[[nodiscard]] LabelledDrive labelled(blind::DrawnColumnDrive& drawn);

/// What the task publishes at each row of `record`, in the arithmetic `Scalar`, run by the loop that is flashed and
/// told of that friction above the bar.
template <class Scalar>
[[nodiscard]] std::vector<Estimate> estimates_of(const Record& record, double wheel_friction_nm = 0);

/// The same of a task whose every tick comes with the next row, whatever its stamp: a clock other than 100 Hz.
[[nodiscard]] std::vector<Estimate> estimates_tick_by_row(const Record& record);

/// In percent of the ticks: how often two runs of the task differ in the state of a parameter, or in its value by more
/// than a tenth of the deviation that the first one states.
[[nodiscard]] double differing_percent(const std::vector<Estimate>& one, const std::vector<Estimate>& other);

/// What a random walk's step from block to block would have to be to move as far in a second as the arm does in the
/// mean square: variances of J, B and C.
[[nodiscard]] Eigen::Vector3d walk_of(const std::vector<WheelArm>& truth);

}  // namespace steerid
