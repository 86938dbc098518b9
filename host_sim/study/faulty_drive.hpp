// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A simulated drive through the firmware's loop during which something is wrong for a while: with the sensors
// (host_sim/sensors) or with the bus between them and the task.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "plant/wheel_arm.hpp"
#include "port/estimate.hpp"
#include "port/sample.hpp"
#include "sensors/sensor_suite.hpp"

namespace steerid {

/// When it is wrong.
struct FaultTime {
  double onset_s = 20;
  double length_s = 5;

  [[nodiscard]] double end_s() const { return onset_s + length_s; }
  [[nodiscard]] sensor::During during() const { return {onset_s, length_s}; }
};

/// By what three channels can show of a fault.
enum class FaultClass : std::uint8_t {
  kRefused,     ///< the supervision sees it in the samples themselves
  kMisfit,      ///< the samples are plausible, but no wheel explains them: the residual gives it away
  kNotVisible,  ///< the samples are those of another wheel, or nearly: only a second sensor could tell
};

/// What went over the bus while the fault lasted, as the bus counts it.
struct BusCount {
  int spoiled = 0;  ///< samples that the fault had in its hands
  int flagged = 0;  ///< samples with a channel that says so itself
  int holes = 0;    ///< runs of samples that were lost or flagged
};

struct Fault {
  std::string name;
  FaultClass kind = FaultClass::kMisfit;
  /// Sets the sensors' defects, if there are any.
  std::function<void(SensorDefects&, const FaultTime&)> sensors = {};
  /// Spoils the sample number `k` since the onset on the bus, if the bus is at fault.
  std::function<void(Sample&, int k)> bus = {};
  /// What the firmware's counters have to say at the end, where that can be counted off; without it they may say more.
  std::function<InputCounters(const BusCount&)> counters = {};
};

/// What the loop handed out at one tick, and what its identifier was worth then.
struct Outcome {
  Estimate estimate;
  bool valid = false;
  bool fault = false;
  bool finite = true;  ///< every number of the identifier, before it becomes an integer
  bool sound = true;   ///< its covariance positive, its parameters inside their limits
};

struct FaultyDrive {
  std::vector<Outcome> outcomes;
  BusCount bus;
};

/// A probe drive of `duration_s` with `fault` in it and as much slow torque that no sensor sees (experiment/tasks.hpp),
/// the task in float.
[[nodiscard]] FaultyDrive faulty_drive(const Fault& fault, const FaultTime& when, double duration_s, std::uint64_t seed,
                                       const WheelArm& wheel, double unmeasured_percent = 0);

}  // namespace steerid
