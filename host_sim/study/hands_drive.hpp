// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One drive of the study of hands (study/hands.hpp), and what each detector says of it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "port/estimate.hpp"

namespace steerid {

inline constexpr double kHandsDrive_s = 60;
inline constexpr double kHandsSettling_s = 10;  ///< after the start no alarm is counted
inline constexpr double kHandsOff_s = 15;       ///< how long the hands are away, and the most that UN R79 allows
inline constexpr double kHandsProbe_nm = 0.5;

/// Of the threshold on the torsion bar's torque, Nm.
inline constexpr std::array kBarThresholds_nm = {0.3, 0.5, 0.7, 1.0};
/// For how long a detector must have said so without a break, s.
inline constexpr std::array kSaidFor_s = {0.0, 0.5, 1.0, 2.0, 4.0, 8.0, 12.0};
inline constexpr std::size_t kHandsDetectors = 1 + kBarThresholds_nm.size();  ///< the task first

/// [detector][place in kSaidFor_s]
template <class T>
using OfEachDetector = std::array<std::array<T, kSaidFor_s.size()>, kHandsDetectors>;

/// "steerid", "bar below 0.3 Nm", ...
[[nodiscard]] std::string hands_detector_name(std::size_t detector);

/// Above the bar, Nm: what there is, and what the task is told of.
struct WheelFriction {
  double there_nm = 0;
  double told_nm = 0;
};

/// In how many ticks the task told each DriverState, in the order of its values.
using StateTicks = std::array<std::size_t, 4>;

/// Drives of a kind with odd numbers are on a rough road.
[[nodiscard]] constexpr bool on_rough_road(std::uint64_t number) { return number % 2 == 1; }
/// Every other pair of held wheels is held by two fingers.
[[nodiscard]] constexpr bool by_two_fingers(std::uint64_t number) { return number % 4 >= 2; }

struct ToldRelease {
  OfEachDetector<double> told_after_s{};  ///< from the moment the hands leave; infinite: not while they are off
  StateTicks ticks{};                     ///< from 6 s after that moment until they are back
};
/// Drive `number` of `seed` whose hands leave for a while: of the project's column, or of the held-out generator.
[[nodiscard]] ToldRelease drawn_release(std::uint64_t seed, std::uint64_t number);
[[nodiscard]] ToldRelease held_out_release(std::uint64_t seed, std::uint64_t number,
                                           const WheelFriction& friction = {});

struct HeldWheel {
  OfEachDetector<int> alarms{};        ///< how often it is told to be let go
  OfEachDetector<double> alarmed_s{};  ///< and for how long in all
  StateTicks ticks{};                  ///< after the settling
};
[[nodiscard]] HeldWheel held_wheel(std::uint64_t seed, std::uint64_t number, const WheelFriction& friction = {});

enum class Rack : std::uint8_t { kAsDrawn, kWithoutFriction };

/// Seconds from the beginning of bracing until `braced` is told; infinite when never.
[[nodiscard]] double braced_after_s(std::uint64_t seed, std::uint64_t number, Rack rack = Rack::kAsDrawn);

}  // namespace steerid
