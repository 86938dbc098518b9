// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the task sends on CAN (layout.hpp): the estimate as five messages every cycle and four with the counters every
// tenth, the probe request as one.
//
//   EstimateMessages messages;                                                            // one for the life of the
//   task for (const Frame& frame : messages.next(estimate, assembly.counters())) send(frame);  // once a tick
//
// Cost: at most nine CRCs of 9 bytes, no division but three by constants.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "can/layout.hpp"
#include "can/protection.hpp"
#include "can/sample_messages.hpp"
#include "port/estimate.hpp"

namespace steerid::can {

/// Steps of the standard deviation, rounded up: the bus never claims more than the task knows.
constexpr std::int64_t deviation_steps(std::int32_t sd_micro, std::int32_t step_micro) {
  return (static_cast<std::int64_t>(sd_micro) + step_micro - 1) / step_micro;
}

class EstimateMessages {
 public:
  static constexpr std::uint8_t kSlowCycle = 10;  ///< cycles between two messages of the counters

  /// The frames of this cycle, `bus` being what the samples' assembly has turned down; the span is valid until the next
  /// call.
  constexpr std::span<const Frame> next(const Estimate& estimate, const SampleCounters& bus) {
    const std::array<ParameterEstimate, 3> parameters{estimate.inertia, estimate.damping, estimate.stiffness};
    bool valid = true;
    bool fault = false;
    for (std::size_t i = 0; i < 3; ++i) {
      Frame& frame = start(i, kParameterIds[i]);
      put(frame, kState, static_cast<std::int64_t>(parameters[i].state));
      put(frame, kValue, parameters[i].value_micro);
      put(frame, kDeviation, deviation_steps(parameters[i].sd_micro, kDeviationStepMicro[i]));
      valid = valid && parameters[i].state == ParameterState::kValid;
      fault = fault || parameters[i].state == ParameterState::kFault;
    }
    Frame& state = start(3, kTaskStateId);
    put(state, kValidBit, valid ? 1 : 0);
    put(state, kFaultBit, fault ? 1 : 0);
    put(state, kStamp, estimate.stamp_us);
    Frame& driver = start(4, kDriverOnWheelId);
    put(driver, kDriverState, static_cast<std::int64_t>(estimate.driver));
    put(driver, kHandCount, static_cast<std::int64_t>(estimate.hands));
    const bool slow = cycle_ == 0;
    if (slow) {
      const InputCounters& counters = estimate.counters;
      count(5, kInputRefusedId, {counters.invalid_channel, counters.out_of_range, counters.spike});
      count(6, kInputTimingId, {counters.repeated, counters.out_of_order, counters.late_tick});
      count(7, kInputGapsId, {counters.accepted_after_gap, counters.stuck, 0});
      Frame& frame = start(8, kInputBusId);
      put(frame, kBusCounters[0], bus.corrupt);
      put(frame, kBusCounters[1], bus.repeated);
      put(frame, kBusCounters[2], bus.incomplete);
      put(frame, kBusCounters[3], bus.refused);
    }
    const std::size_t frames = slow ? kAll : kFast;
    for (std::size_t i = 0; i < kFast; ++i) protect(frames_[i], alive_);
    for (std::size_t i = kFast; i < frames; ++i) protect(frames_[i], slow_alive_);
    alive_ = next_alive(alive_);
    if (slow) slow_alive_ = next_alive(slow_alive_);
    cycle_ = cycle_ + 1 == kSlowCycle ? std::uint8_t{0} : static_cast<std::uint8_t>(cycle_ + 1);
    return std::span<const Frame>(frames_).first(frames);
  }

 private:
  static constexpr std::size_t kFast = 5;
  static constexpr std::size_t kAll = 9;

  constexpr Frame& start(std::size_t at, std::uint16_t id) {
    frames_[at] = Frame{.id = id, .length = 8, .data = {}};
    return frames_[at];
  }
  constexpr void count(std::size_t at, std::uint16_t id, const std::array<std::uint16_t, 3>& values) {
    Frame& frame = start(at, id);
    for (std::size_t i = 0; i < 3; ++i) put(frame, kCounters[i], values[i]);
  }

  std::array<Frame, kAll> frames_{};
  std::uint8_t alive_ = 0;
  std::uint8_t slow_alive_ = 0;
  std::uint8_t cycle_ = 0;
};

/// The torque that the task asks the EPS to add, in mNm; `alive` is 0 to 14, one more with each cycle.
constexpr Frame probe_request(std::int32_t torque_mnm, std::uint8_t alive) {
  Frame frame{.id = kProbeRequestId, .length = 8, .data = {}};
  put(frame, kProbeTorque, torque_mnm);
  protect(frame, alive);
  return frame;
}

}  // namespace steerid::can
