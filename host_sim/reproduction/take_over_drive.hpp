// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A drive in which the driver does what a take-over function has to notice: braces, steers, takes the second hand, lets
// go, comes back. Each stretch has its own arm and task; the wheel's angle and rate go on across the seams.
//
//   30 s  braced, one hand      passive task: the EPS's triangle, the driver holds against it
//   30 s  relaxed, one hand     active task: about 1 rad at 0.25 Hz
//   30 s  relaxed, both hands   active task
//   30 s  braced, both hands    passive task
//   20 s  hands off             the wheel alone: J 0.018 kg m2, B 0.08 Nms/rad, and the EPS's own centring, 1 Nm/rad
//   30 s  braced, one hand
//
// All through it the EPS adds a small probe. The sensors are those of a production wheel.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "experiment/virtual_subject.hpp"
#include "log/record.hpp"
#include "port/estimate.hpp"

namespace steerid {

struct TakeOverSettings {
  HandPosition one_hand =
      HandPosition::kRight3;  ///< one of the right arm's; both hands are at the grip that goes with it
  double probe_rms_nm = 0.5;
  double unmeasured_percent = 0.5;
  double stiffness_swing = 0;  ///< C of the held wheel drifts by this share (stiffness_drift.hpp)
  std::uint64_t seed = 1;
};

/// What the driver truly did over a stretch of the drive.
struct Stretch {
  double from_s = 0;
  double to_s = 0;
  DriverState state = DriverState::kUnknown;
  HandCount hands = HandCount::kUnknown;
  WheelArm arm{};
};

struct TakeOverDrive {
  Record record;
  std::vector<Stretch> truth;
};

inline constexpr WheelArm kWheelAlone{0.018, 0.08, 1.0};

[[nodiscard]] TakeOverDrive make_take_over_drive(const VirtualSubject& subject, const TakeOverSettings& settings);

}  // namespace steerid
