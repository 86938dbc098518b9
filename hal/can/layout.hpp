// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Where everything lies on the bus: the same as steerid.dbc, which a test holds against this file.
//
// | id    | message       | cycle  | sender | what                                                          |
// | 0x120 | WheelAngle    | 10 ms  | EPS    | angle, its valid bit, the sample's number                     |
// | 0x121 | WheelTorque   | 10 ms  | EPS    | driver's and motor's torque, their valid bits                 |
// | 0x122 | WheelTime     | 10 ms  | EPS    | when the sensors were sampled, whether WheelColumn is sent    |
// | 0x123 | WheelColumn   | 10 ms  | EPS    | torsion bar, rim, probe, their valid bits; if there are any   |
// | 0x130 | ArmInertia    | 10 ms  | ECU    | value, standard deviation, state                              |
// | 0x131 | ArmDamping    | 10 ms  | ECU    | the same                                                      |
// | 0x132 | ArmStiffness  | 10 ms  | ECU    | the same                                                      |
// | 0x133 | TaskState     | 10 ms  | ECU    | valid and fault, the stamp of the last sample in the estimate |
// | 0x134 | ProbeRequest  | 10 ms  | ECU    | the torque that the task asks the EPS to add                  |
// | 0x135 | DriverOnWheel | 10 ms  | ECU    | what the driver is doing, and with how many hands             |
// | 0x136 | InputRefused  | 100 ms | ECU    | counters: invalid channel, out of range, spike                |
// | 0x137 | InputTiming   | 100 ms | ECU    | counters: repeated, out of order, late tick                   |
// | 0x138 | InputGaps     | 100 ms | ECU    | counters: accepted after a gap, stuck                         |
// | 0x139 | InputBus      | 100 ms | ECU    | frames corrupt, repeated; samples incomplete, refused         |
//
// The EPS messages of one sample carry the same alive counter. There are three, or four where WheelTime says that the
// sample has a WheelColumn. An EPS without torque_driver clears its valid bit in WheelTorque. Values are in the port's
// integers (urad, mNm, us, micro-units); standard deviations are rounded up to steps of 2e-6, 5e-5 and 1e-3 of the SI
// unit and stop at 65535.
#pragma once

#include <array>
#include <cstdint>

#include "can/frame.hpp"

namespace steerid::can {

inline constexpr std::uint16_t kWheelAngleId = 0x120;
inline constexpr std::uint16_t kWheelTorqueId = 0x121;
inline constexpr std::uint16_t kWheelTimeId = 0x122;
inline constexpr std::uint16_t kWheelColumnId = 0x123;
inline constexpr std::array<std::uint16_t, 3> kParameterIds{0x130, 0x131, 0x132};  ///< J, B, C
inline constexpr std::uint16_t kTaskStateId = 0x133;
inline constexpr std::uint16_t kProbeRequestId = 0x134;
inline constexpr std::uint16_t kDriverOnWheelId = 0x135;
inline constexpr std::uint16_t kInputRefusedId = 0x136;
inline constexpr std::uint16_t kInputTimingId = 0x137;
inline constexpr std::uint16_t kInputGapsId = 0x138;
inline constexpr std::uint16_t kInputBusId = 0x139;

inline constexpr Signal kAngleValidBit{.start = 12, .length = 1};  // WheelAngle
inline constexpr Signal kAngle{.start = 16, .length = 32, .is_signed = true};
inline constexpr Signal kSampleNumber{.start = 48, .length = 16};

inline constexpr Signal kTorqueDriverValidBit{.start = 12, .length = 1};  // WheelTorque
inline constexpr Signal kTorqueMotorValidBit{.start = 13, .length = 1};
inline constexpr Signal kTorqueDriver{.start = 16, .length = 24, .is_signed = true};
inline constexpr Signal kTorqueMotor{.start = 40, .length = 24, .is_signed = true};

inline constexpr Signal kColumnSentBit{.start = 12, .length = 1};  // WheelTime

inline constexpr Signal kTorqueBarValidBit{.start = 12, .length = 1};  // WheelColumn
inline constexpr Signal kTorqueRimValidBit{.start = 13, .length = 1};
inline constexpr Signal kProbeValidBit{.start = 14, .length = 1};
inline constexpr Signal kTorqueBar{.start = 16, .length = 16, .is_signed = true};
inline constexpr Signal kTorqueRim{.start = 32, .length = 16, .is_signed = true};
inline constexpr Signal kProbe{.start = 48, .length = 16, .is_signed = true};

inline constexpr Signal kStamp{.start = 16, .length = 48};  // WheelTime, TaskState

inline constexpr Signal kState{.start = 12, .length = 4};  // ArmInertia, ArmDamping, ArmStiffness
inline constexpr Signal kValue{.start = 16, .length = 32, .is_signed = true};
inline constexpr Signal kDeviation{.start = 48, .length = 16};
inline constexpr std::array<std::int32_t, 3> kDeviationStepMicro{2, 50, 1000};  ///< J, B, C

inline constexpr Signal kValidBit{.start = 12, .length = 1};  // TaskState
inline constexpr Signal kFaultBit{.start = 13, .length = 1};

inline constexpr Signal kProbeTorque{.start = 16, .length = 16, .is_signed = true};  // ProbeRequest

inline constexpr Signal kDriverState{.start = 12, .length = 4};  // DriverOnWheel
inline constexpr Signal kHandCount{.start = 16, .length = 4};

inline constexpr std::array<Signal, 3> kCounters{Signal{16, 16}, Signal{32, 16}, Signal{48, 16}};  // Input...
/// InputBus; they stop at 4095.
inline constexpr std::array<Signal, 4> kBusCounters{Signal{16, 12}, Signal{28, 12}, Signal{40, 12}, Signal{52, 12}};

}  // namespace steerid::can
