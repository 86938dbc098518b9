// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "experiment/virtual_driver.hpp"

#include <cmath>
#include <numbers>

namespace steerid {
namespace {

constexpr SmoothNoiseSettings kRestlessness{.rms = 0.15, .corner_hz = 0.5, .damping_ratio = 1.0};
constexpr SmoothNoiseSettings kTremor{.rms = 0.02, .corner_hz = 9.0, .damping_ratio = 0.1};
constexpr double kWanderCornerHz = 0.03;  // a cycle takes 4 s: neighbouring cycles are alike, distant ones are not
constexpr double kCorrectionCornerHz = 1.0;
constexpr double kFadeS = 2.0;

double angular(double frequency_hz) { return 2.0 * std::numbers::pi * frequency_hz; }

double in_phase(const WheelArm& arm, double w) { return arm.stiffness_nm_per_rad - arm.inertia_kgm2 * w * w; }
double quadrature(const WheelArm& arm, double w) { return arm.damping_nms_per_rad * w; }

double steering_rms(const SteeringSettings& settings, const WheelArm& arm) {
  const double w = angular(settings.frequency_hz);
  return settings.amplitude_rad * std::hypot(in_phase(arm, w), quadrature(arm, w)) / std::numbers::sqrt2;
}

}  // namespace

HoldingDriver::HoldingDriver(std::uint64_t seed, std::uint64_t first_stream)
    : restlessness_(kRestlessness, seed, first_stream), tremor_(kTremor, seed, first_stream + 1) {}

SteeringDriver::SteeringDriver(const SteeringSettings& settings, const WheelArm& arm, std::uint64_t seed,
                               std::uint64_t first_stream)
    : settings_(settings),
      stiffness_nm_per_rad_(arm.stiffness_nm_per_rad),
      in_phase_nm_per_rad_(in_phase(arm, angular(settings.frequency_hz))),
      quadrature_nm_per_rad_(quadrature(arm, angular(settings.frequency_hz))),
      amplitude_({.rms = settings.amplitude_spread * settings.amplitude_rad, .corner_hz = kWanderCornerHz}, seed,
                 first_stream),
      // The momentary frequency is the slope of the phase: its rms is that of the phase times the corner's rate.
      wander_({.rms = settings.period_spread * settings.frequency_hz / kWanderCornerHz, .corner_hz = kWanderCornerHz},
              seed, first_stream + 1),
      offset_({.rms = settings.offset_spread_rad, .corner_hz = kWanderCornerHz}, seed, first_stream + 2),
      corrections_({.rms = settings.correction_share * steering_rms(settings, arm), .corner_hz = kCorrectionCornerHz},
                   seed, first_stream + 3),
      tremor_(kTremor, seed, first_stream + 4) {}

SignalPoint SteeringDriver::fade() const {
  const double u = static_cast<double>(tick_) * kTickS / kFadeS;
  if (u >= 1.0) return {1.0, 0.0};
  return {u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u) / kFadeS};
}

SignalPoint SteeringDriver::steering(SignalPoint amplitude, SignalPoint wander, SignalPoint offset) const {
  const double turns = settings_.frequency_hz * (static_cast<double>(tick_) * kTickS);
  const double phase = angular(turns - std::floor(turns)) + wander.value;
  const double phase_slope = angular(settings_.frequency_hz) + wander.slope;
  const double s = std::sin(phase);
  const double c = std::cos(phase);
  const double wave = in_phase_nm_per_rad_ * s + quadrature_nm_per_rad_ * c;
  const double wave_slope = (in_phase_nm_per_rad_ * c - quadrature_nm_per_rad_ * s) * phase_slope;
  return {amplitude.value * wave + stiffness_nm_per_rad_ * offset.value,
          amplitude.slope * wave + amplitude.value * wave_slope + stiffness_nm_per_rad_ * offset.slope};
}

SignalPoint SteeringDriver::next() {
  const SignalPoint amplitude = SignalPoint{settings_.amplitude_rad, 0.0} + amplitude_.next();
  const SignalPoint torque = steering(amplitude, wander_.next(), offset_.next());
  const SignalPoint rise = fade();
  ++tick_;
  return SignalPoint{rise.value * torque.value, rise.slope * torque.value + rise.value * torque.slope} +
         corrections_.next() + tremor_.next();
}

double SteeringDriver::nominal_rms_nm() const {
  return settings_.amplitude_rad * std::hypot(in_phase_nm_per_rad_, quadrature_nm_per_rad_) / std::numbers::sqrt2;
}

}  // namespace steerid
