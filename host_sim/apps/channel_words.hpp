// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What is said of a record's channels: which equation they allow, and where one seems to be another.
#pragma once

#include <string>
#include <string_view>

#include "fit/channel_check.hpp"
#include "fit/instrumental_fit.hpp"
#include "log/record.hpp"
#include "port/equation.hpp"

namespace steerid {

/// The equation in one line, with what it identifies.
[[nodiscard]] std::string equation_words(Equation equation);

/// A sentence that names the right channels; empty when they are as named.
[[nodiscard]] std::string pair_words(const TorquePair& pair);

/// What the wheel between rim and bar says of the two sensors, one sentence.
[[nodiscard]] std::string wheel_words(const WheelBetween& wheel);

/// That a simulation is driven without the driver's own torque (plant/driving_torques.hpp); empty where that is known.
[[nodiscard]] std::string driving_words(const Record& record);

/// How much of a record may be the driver's own torque that is in no column, and what to do where that is too much.
/// Empty where that torque is known, or the record is too short. `record` is at 100 Hz.
[[nodiscard]] std::string own_torque_words(const Record& record);

/// True when what is identified from these sensors is not credible.
[[nodiscard]] bool contradicts(const WheelBetween& wheel);

/// That the sensor of `equation` is turned round, since the arm that it makes has a negative inertia.
[[nodiscard]] std::string turned_words(Equation equation, const InstrumentalFit& fit);

/// That a torque which does not fit may be another channel.
[[nodiscard]] std::string may_be_reaction(std::string_view channel);

}  // namespace steerid
