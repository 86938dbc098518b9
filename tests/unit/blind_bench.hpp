// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A drawn wheel on the bench: exact sensors, one tone or any torque, no noise, so that closed forms can be held beside
// what the blind generator writes down.
#pragma once

#include <complex>
#include <cstddef>
#include <functional>
#include <numbers>
#include <string_view>
#include <utility>

#include "blind/catalogue.hpp"
#include "blind/simulation.hpp"

namespace steerid::test {

using Complex = std::complex<double>;

struct BlindBench {
  blind::Arm arm{0.1, 1.2, 25.0};
  blind::Run run{.lead_in_s = 30, .duration_s = 10};
  blind::Sensors sensors{};
  blind::Elements elements{};
  blind::Setting setting{.arm = arm};

  BlindBench& with(std::string_view id, const blind::Numbers& numbers) {
    setting.arm = arm;
    setting.duration_s = run.duration_s;
    elements.push_back(blind::kind_called(id).make(numbers, setting));
    return *this;
  }

  [[nodiscard]] blind::Signal signal(const std::function<double(double)>& torque) const {
    return {torque, -run.lead_in_s - 1, run.duration_s + 1};
  }
  [[nodiscard]] Record drive(const std::function<double(double)>& driver_nm) const {
    return blind::simulate(arm, {.driver = signal(driver_nm), .motor = {}, .unseen = {}}, elements, sensors, run, 1)
        .record;
  }
};

inline Complex s_of(double frequency_hz) { return {0, 2 * std::numbers::pi * frequency_hz}; }

/// Second-order Butterworth low-pass.
inline Complex butterworth(double frequency_hz, double corner_hz) {
  const Complex s = s_of(frequency_hz) / (2 * std::numbers::pi * corner_hz);
  return 1.0 / (s * s + std::numbers::sqrt2 * s + 1.0);
}

/// The complex amplitude of a column at a frequency of which the record holds whole cycles: sin is 1, cos is i.
inline Complex amplitude(const std::vector<double>& time_s, const std::vector<double>& column, double frequency_hz) {
  Complex sum = 0;
  for (std::size_t i = 0; i < column.size(); ++i) sum += column[i] * std::exp(-s_of(frequency_hz) * time_s[i]);
  return Complex{0, 2} * sum / static_cast<double>(column.size());
}

}  // namespace steerid::test
