// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One published estimate: what leaves the 100 Hz task, in integers (micro-units), once a tick.
#pragma once

#include <cstdint>

namespace steerid {

/// What is known of one parameter.
enum class ParameterState : std::uint8_t {
  kStarting = 0,    ///< not enough data since start or restart
  kConverging = 1,  ///< being learned; its standard deviation is still too large to use
  kValid = 2,       ///< learned, and its standard deviation is below the limit for use
  kHolding = 3,     ///< not excited lately: the value is kept, and may be old; its deviation follows the noise
  kFault = 4,       ///< the input is faulty; the value is the last good one
  kNotExcited = 5,  ///< not learned: the prior, or what a weak motion made of it; says nothing about this driver
};

constexpr const char* name(ParameterState state) {
  switch (state) {
    case ParameterState::kStarting:
      return "starting";
    case ParameterState::kConverging:
      return "converging";
    case ParameterState::kValid:
      return "valid";
    case ParameterState::kHolding:
      return "holding";
    case ParameterState::kFault:
      return "fault";
    case ParameterState::kNotExcited:
      return "not excited";
  }
  return "unknown";
}

/// Value and one standard deviation in micro-units (1e-6 kg m2, 1e-6 Nms/rad, 1e-6 Nm/rad); saturate at int32.
struct ParameterEstimate {
  std::int32_t value_micro = 0;
  std::int32_t sd_micro = 0;
  ParameterState state = ParameterState::kStarting;
};

/// What was noticed about the input, each a counter that stops at 65535. The first and the last count what was used all
/// the same; the others count samples that were turned down, and say why (app/input_supervision.hpp). "Last" is the
/// last accepted sample.
struct InputCounters {
  std::uint16_t accepted_after_gap = 0;  ///< accepted samples with missing ones before them
  std::uint16_t invalid_channel = 0;     ///< the valid bit of a channel that the equation uses was cleared
  std::uint16_t out_of_range = 0;        ///< outside the physical range of the wheel
  std::uint16_t spike = 0;               ///< farther from the last sample than wheel or torque can have moved meanwhile
  std::uint16_t stuck = 0;               ///< the angle has not moved for 0.3 s although the torque did
  std::uint16_t repeated = 0;            ///< the last stamp again, or less than half a period after it
  std::uint16_t out_of_order = 0;        ///< a stamp before the last one
  std::uint16_t late_tick = 0;           ///< ticks that came after their deadline
};

/// What the arm on the wheel is doing, by what is known at this very tick (firmware/app/driver_state.hpp); never a
/// guess from what was known before.
enum class DriverState : std::uint8_t {
  kUnknown = 0,   ///< the parameters that would tell are not valid, or lie between two states, as with a finger
  kHandsOff = 1,  ///< nobody holds the wheel
  kRelaxed = 2,   ///< an arm that steers: compliant, well damped
  kBraced = 3,    ///< an arm that holds against something: co-contracted, stiff
};

/// How many hands hold the wheel, where it can be told.
enum class HandCount : std::uint8_t { kUnknown = 0, kNone = 1, kOne = 2, kTwo = 3 };

constexpr const char* name(DriverState state) {
  switch (state) {
    case DriverState::kUnknown:
      return "unknown";
    case DriverState::kHandsOff:
      return "hands_off";
    case DriverState::kRelaxed:
      return "relaxed";
    case DriverState::kBraced:
      return "braced";
  }
  return "unknown";
}

constexpr const char* name(HandCount hands) {
  switch (hands) {
    case HandCount::kUnknown:
      return "unknown";
    case HandCount::kNone:
      return "none";
    case HandCount::kOne:
      return "one";
    case HandCount::kTwo:
      return "two";
  }
  return "unknown";
}

struct Estimate {
  std::int64_t stamp_us = 0;  ///< of the sample that this estimate includes last
  ParameterEstimate inertia;
  ParameterEstimate damping;
  ParameterEstimate stiffness;
  DriverState driver = DriverState::kUnknown;
  HandCount hands = HandCount::kUnknown;
  InputCounters counters;
};

}  // namespace steerid
