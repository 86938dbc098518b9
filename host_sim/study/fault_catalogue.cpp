// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/fault_catalogue.hpp"

#include <algorithm>
#include <utility>

namespace steerid {
namespace {

using D = SensorDefects;
using T = FaultTime;
using K = FaultClass;

constexpr std::int64_t kDayUs = 86'400'000'000;
constexpr int kAccepted = 20;  ///< the supervision accepts a stamp from before on its twentieth time in a row

/// A scramble of k in -range .. range.
std::int32_t scrambled(int k, std::int32_t range) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(k) * 2654435761U) % range;
}

std::uint16_t counter(int value) { return static_cast<std::uint16_t>(std::clamp(value, 0, 65535)); }

/// How many of 0 .. n - 1 are multiples of `every`.
int multiples(int n, int every) { return (n + every - 1) / every; }

std::vector<Fault> refused() {
  return {
      {"Loss30",
       K::kRefused,
       [](D& d, const T& t) {
         d.message_loss = {0.3, 3, false, t.during()};
       },
       {},
       [](const BusCount& n) { return InputCounters{.accepted_after_gap = counter(n.holes)}; }},
      {"Loss90",
       K::kRefused,
       [](D& d, const T& t) {
         d.message_loss = {0.9, 30, false, t.during()};
       },
       {},
       [](const BusCount& n) { return InputCounters{.accepted_after_gap = counter(n.holes)}; }},
      {"FlaggedDropout",
       K::kRefused,
       [](D& d, const T& t) {
         d.angle.dropout = {0.5, 5, true, t.during()};
       },
       {},
       [](const BusCount& n) {
         return InputCounters{.accepted_after_gap = counter(n.holes), .invalid_channel = counter(n.flagged)};
       }},
      {"AngleStuck", K::kRefused, [](D& d, const T& t) { d.angle.stuck.during = t.during(); }},
      {"ChannelInvalid",
       K::kRefused,
       {},
       [](Sample& s, int) { s.valid_bits = 0; },
       [](const BusCount& n) { return InputCounters{.accepted_after_gap = 1, .invalid_channel = counter(n.flagged)}; }},
      {"ExtremeAngle",
       K::kRefused,
       {},
       [](Sample& s, int k) { s.angle_urad = k % 2 == 0 ? INT32_MIN : INT32_MAX; },
       [](const BusCount& n) { return InputCounters{.accepted_after_gap = 1, .out_of_range = counter(n.spoiled)}; }},
      {"ExtremeTorqueAtTimes",
       K::kRefused,
       {},
       [](Sample& s, int k) { s.torque_motor_mnm = k % 3 == 0 ? INT32_MAX : s.torque_motor_mnm; },
       [](const BusCount& n) {
         return InputCounters{.accepted_after_gap = counter(multiples(n.spoiled, 3)),
                              .out_of_range = counter(multiples(n.spoiled, 3))};
       }},
      {"StampStandsStill",
       K::kRefused,
       {},
       [](Sample& s, int k) { s.stamp_us -= k * kTickPeriodUs; },
       [](const BusCount& n) {
         return InputCounters{.accepted_after_gap = counter(n.spoiled > 1 ? 1 : 0), .repeated = counter(n.spoiled - 1)};
       }},
      {"EverySecondStampRepeats",
       K::kRefused,
       {},
       [](Sample& s, int k) { s.stamp_us -= k % 2 * kTickPeriodUs; },
       [](const BusCount& n) {
         return InputCounters{.accepted_after_gap = counter(n.spoiled / 2), .repeated = counter(n.spoiled / 2)};
       }},
      {"ADayBack",
       K::kRefused,
       {},
       [](Sample& s, int) { s.stamp_us -= kDayUs; },
       [](const BusCount& n) {
         return InputCounters{.accepted_after_gap = 1, .out_of_order = counter(std::min(n.spoiled, kAccepted - 1))};
       }},
      {"ADayAhead",
       K::kRefused,
       {},
       [](Sample& s, int) { s.stamp_us += kDayUs; },
       [](const BusCount&) { return InputCounters{.accepted_after_gap = 1, .out_of_order = kAccepted - 1}; }},
      {"ADayAheadAtTimes",
       K::kRefused,
       {},
       [](Sample& s, int k) { s.stamp_us += k % 100 == 0 ? kDayUs : 0; },
       [](const BusCount& n) {
         return InputCounters{.accepted_after_gap = counter(multiples(n.spoiled, 100)),
                              .out_of_order = counter((kAccepted - 1) * multiples(n.spoiled, 100))};
       }},
      {"Spikes",
       K::kRefused,
       {},
       [](Sample& s, int k) { s.angle_urad += k % 5 == 0 ? 1'000'000 : 0; },
       [](const BusCount& n) {
         return InputCounters{.accepted_after_gap = counter(multiples(n.spoiled, 5)),
                              .spike = counter(multiples(n.spoiled, 5))};
       }},
  };
}

std::vector<Fault> misfits() {
  return {
      {"SilentAngleDropout", K::kMisfit,
       [](D& d, const T& t) {
         d.angle.dropout = {0.3, 3, false, t.during()};
       }},
      {"SilentTorqueDropout", K::kMisfit,
       [](D& d, const T& t) {
         d.torque_motor.dropout = {0.3, 3, false, t.during()};
       }},
      {"MotorTorqueStuck", K::kMisfit, [](D& d, const T& t) { d.torque_motor.stuck.during = t.during(); }},
      {"AngleBias", K::kMisfit,
       [](D& d, const T& t) {
         d.angle.bias = {0.1, 0, t.during()};
       }},
      {"AngleDrift", K::kMisfit,
       [](D& d, const T& t) {
         d.angle.bias = {0, 0.02, t.during()};
       }},
      {"MotorTorqueBias", K::kMisfit,
       [](D& d, const T& t) {
         d.torque_motor.bias = {2, 0, t.during()};
       }},
      {"AngleTurnedRound", K::kMisfit,
       [](D& d, const T& t) {
         d.angle.gain = {-1, t.during()};
       }},
      {"MotorTorqueTurnedRound", K::kMisfit,
       [](D& d, const T& t) {
         d.torque_motor.gain = {-1, t.during()};
       }},
      {"TorquesSwapped", K::kMisfit, {}, [](Sample& s, int) { std::swap(s.torque_driver_mnm, s.torque_motor_mnm); }},
      {"AngleAndDriverTorqueSwapped",
       K::kMisfit,
       {},
       [](Sample& s, int) { std::swap(s.angle_urad, s.torque_driver_mnm); }},
      {"AngleAndMotorTorqueSwapped",
       K::kMisfit,
       {},
       [](Sample& s, int) { std::swap(s.angle_urad, s.torque_motor_mnm); }},
      {"RandomAngle", K::kMisfit, {}, [](Sample& s, int k) { s.angle_urad = scrambled(k, 300'000); }},
      {"NoisyAngle", K::kMisfit, {}, [](Sample& s, int k) { s.angle_urad += scrambled(k, 30'000); }},
      {"NoisyTorque", K::kMisfit, {}, [](Sample& s, int k) { s.torque_motor_mnm += scrambled(k, 3'000); }},
      {"SmallSpikes", K::kMisfit, {}, [](Sample& s, int k) { s.angle_urad += k % 5 == 0 ? 50'000 : 0; }},
      {"NoTorque", K::kMisfit, {}, [](Sample& s, int) { s.torque_driver_mnm = s.torque_motor_mnm = 0; }},
      {"AllZero", K::kMisfit, {}, [](Sample& s, int) { s.angle_urad = s.torque_driver_mnm = s.torque_motor_mnm = 0; }},
      {"BiasAndLossAndNoise", K::kMisfit,
       [](D& d, const T& t) {
         d.angle.bias = {0.1, 0, t.during()};
         d.message_loss = {0.2, 3, false, t.during()};
       },
       [](Sample& s, int k) { s.torque_motor_mnm += scrambled(k, 2'000); }},
  };
}

std::vector<Fault> not_visible() {
  return {
      {"AngleGain", K::kNotVisible,
       [](D& d, const T& t) {
         d.angle.gain = {1.2, t.during()};
       }},
      {"MotorTorqueGain", K::kNotVisible,
       [](D& d, const T& t) {
         d.torque_motor.gain = {1.5, t.during()};
       }},
      {"AngleClipped", K::kNotVisible,
       [](D& d, const T& t) {
         d.angle.saturation = {0.05, t.during()};
       }},
      {"MotorTorqueClipped", K::kNotVisible,
       [](D& d, const T& t) {
         d.torque_motor.saturation = {1, t.during()};
       }},
      {"AngleLag", K::kNotVisible,
       [](D& d, const T& t) {
         d.angle.lag = {0.05, t.during()};
       }},
      {"AngleDelay", K::kNotVisible,
       [](D& d, const T& t) {
         d.angle.delay = {50'000, t.during()};
       }},
      {"DriverTorqueStuck", K::kNotVisible, [](D& d, const T& t) { d.torque_driver.stuck.during = t.during(); }},
      {"Jitter", K::kNotVisible,
       [](D& d, const T& t) {
         d.jitter = {9'999, true, t.during()};
       }},
      {"JitterUnstamped", K::kNotVisible,
       [](D& d, const T& t) {
         d.jitter = {9'999, false, t.during()};
       }},
  };
}

}  // namespace

const std::vector<Fault>& all_faults() {
  static const std::vector<Fault> kAll = [] {
    std::vector<Fault> all = refused();
    for (auto& more : {misfits(), not_visible()}) all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return kAll;
}

Fault both(const Fault& first, const Fault& second) {
  Fault fault{first.name + "And" + second.name, std::max(first.kind, second.kind)};
  fault.sensors = [a = first.sensors, b = second.sensors](D& d, const T& t) {
    if (a) a(d, t);
    if (b) b(d, t);
  };
  fault.bus = [a = first.bus, b = second.bus](Sample& s, int k) {
    if (a) a(s, k);
    if (b) b(s, k);
  };
  return fault;
}

}  // namespace steerid
