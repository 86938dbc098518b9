// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/steady_drive.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "sensors/random.hpp"

namespace steerid {
namespace {

using Complex = std::complex<double>;

constexpr double kCorner_hz = 0.3;
constexpr double kLineSpacing_hz = 1.0 / 64.0;

/// To 5 Hz, where the density behind two low passes is 1.3e-5 of its top; to 20 Hz, where it is 2.2e-4 of it behind
/// one, and a tenth of the torque sees no more than a hundredth of the angle's noise of it.
int lines(int low_passes) { return low_passes == 1 ? 1280 : 320; }

double shape(double f_hz, int low_passes) {
  const double x = f_hz / kCorner_hz;
  return low_passes == 1 ? 1.0 / (1.0 + x * x) : 1.0 / ((1.0 + x * x) * (1.0 + x * x));
}

/// Sum of shape() over the lines, so that the lines' power is what was asked for.
double shape_sum(int low_passes) {
  double sum = 0;
  for (int k = 1; k <= lines(low_passes); ++k) sum += shape(k * kLineSpacing_hz, low_passes);
  return sum;
}

/// Power of a line at 0 Hz.
double strongest_line(const SteadyDrive& drive) {
  return drive.unmeasured_torque_nm * drive.unmeasured_torque_nm / shape_sum(drive.unmeasured_low_passes);
}

Complex gain(const WheelArm& wheel, double w) {
  return 1.0 / Complex(wheel.stiffness_nm_per_rad - wheel.inertia_kgm2 * w * w, wheel.damping_nms_per_rad * w);
}

/// Adds a tone to the angle and, when it is measured, to the torque. The phasor is turned from sample to sample.
void add_tone(const SteadyDrive& drive, double f_hz, Complex phasor, std::vector<double>* torque,
              std::vector<double>& angle) {
  const double w = 2 * std::numbers::pi * f_hz;
  const Complex turn = std::polar(1.0, w / kStudyRate_hz);
  const Complex response = gain(drive.wheel, w);
  for (std::size_t i = 0; i < drive.samples; ++i) {
    if (torque != nullptr) (*torque)[i] += phasor.real();
    angle[i] += (response * phasor).real();
    phasor *= turn;
  }
}

}  // namespace

double SteadyDrive::tone_nm() const { return probe_rms_nm * std::sqrt(2.0 / kTones); }

double unmeasured_density(const SteadyDrive& drive, double f_hz) {
  const double line_power = strongest_line(drive) * shape(f_hz, drive.unmeasured_low_passes);
  return kStudyRate_hz * line_power / (2 * kLineSpacing_hz);
}

Record record_of(const SteadyDrive& drive, std::uint64_t seed, std::uint64_t number) {
  enum Source : std::uint64_t { kPhases, kUnmeasured, kTorqueNoise, kAngleNoise, kSources };
  const auto source = [&](Source which) { return Random(seed, number * kSources + which); };
  std::vector<double> torque(drive.samples);
  std::vector<double> angle(drive.samples);
  Random phases = source(kPhases);
  for (int k = kFirstTone; k <= kLastTone; ++k) {
    const Complex phasor = std::polar(drive.tone_nm(), 2 * std::numbers::pi * phases.uniform());
    add_tone(drive, k / kProbePeriod_s, phasor, &torque, angle);
  }
  if (drive.unmeasured_torque_nm > 0) {
    Random amplitudes = source(kUnmeasured);
    const double power = strongest_line(drive);
    for (int k = 1; k <= lines(drive.unmeasured_low_passes); ++k) {
      const double f_hz = k * kLineSpacing_hz;
      const double sd = std::sqrt(power * shape(f_hz, drive.unmeasured_low_passes));
      const double in_phase = sd * amplitudes.normal();
      add_tone(drive, f_hz, {in_phase, sd * amplitudes.normal()}, nullptr, angle);
    }
  }
  Random torque_noise = source(kTorqueNoise);
  Random angle_noise = source(kAngleNoise);
  Record record;
  record.torque_motor_nm.assign(drive.samples, 0.0);
  for (std::size_t i = 0; i < drive.samples; ++i) {
    record.time_s.push_back(static_cast<double>(i) / kStudyRate_hz);
    record.torque_driver_nm.push_back(torque[i] + drive.torque_noise_nm * torque_noise.normal());
    double seen = angle[i] + drive.angle_noise_rad * angle_noise.normal();
    if (drive.angle_step_rad > 0) seen = drive.angle_step_rad * std::round(seen / drive.angle_step_rad);
    record.angle_rad.push_back(seen);
  }
  return record;
}

}  // namespace steerid
