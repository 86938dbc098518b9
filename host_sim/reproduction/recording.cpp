// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduction/recording.hpp"

#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>

#include "plant/plant.hpp"
#include "reproduction/stiffness_drift.hpp"
#include "sensors/random.hpp"

namespace steerid {
namespace {

constexpr int kReadings = 10;  // a tick: 1000 Hz over 100 Hz
constexpr double kReading_s = kTickS / kReadings;
constexpr int kWindow = 2 * kReadings - 1;
constexpr std::uint64_t kGraspStream = 300;
constexpr std::uint64_t kNoiseStream = 320;

/// Everything that is read at one instant, and the truth beside it.
struct Reading {
  std::array<GraspForce, 2> force{};
  double driver_nm = 0;  // reconstructed
  double motor_nm = 0;
  double angle_rad = 0;
  double true_driver_nm = 0;
  double true_angle_rad = 0;
};

std::array<double, kWindow> hann() {
  std::array<double, kWindow> weights{};
  double sum = 0;
  for (int i = 0; i < kWindow; ++i) {
    weights[static_cast<std::size_t>(i)] = 1 - std::cos(2 * std::numbers::pi * (i + 1) / (kWindow + 1));
    sum += weights[static_cast<std::size_t>(i)];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

double in_steps(double value, double step) { return step > 0 ? step * std::round(value / step) : value; }

/// The transducers' noise and resolution.
class Transducers {
 public:
  Transducers(const Instruments& instruments, std::uint64_t seed)
      : instruments_(instruments), random_(seed, kNoiseStream) {}

  double force_n(double value) {
    return in_steps(value + instruments_.force_noise_n * random_.normal(), instruments_.force_step_n);
  }
  double angle_rad(double value) {
    return in_steps(value + instruments_.angle_noise_rad * random_.normal(), instruments_.angle_step_rad);
  }

 private:
  Instruments instruments_;
  Random random_;
};

TaskSettings task_of(const RecordingSettings& settings) {
  TaskSettings task = task_settings(settings.task, settings.hands, settings.seed);
  task.arm = settings.arm;
  task.probe.rms_nm = settings.probe_rms_nm;
  task.unmeasured_percent = settings.unmeasured_percent;
  return task;
}

/// The drive, reading by reading.
std::vector<Reading> read_drive(const RecordingSettings& settings, std::size_t ticks) {
  Task task(task_of(settings));
  Grasp grasp(settings.hands, settings.seed, kGraspStream);
  Transducers transducers(settings.instruments, settings.seed);
  const std::vector<Effect> effects = stiffness_drift(settings.stiffness_swing, settings.seed);
  Plant plant(effects, {.wheel = settings.arm, .seed = settings.seed});
  plant.start(0.0, {});
  std::vector<Reading> readings;
  readings.reserve(ticks * kReadings);
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    const TaskTorques torques = task.next();
    grasp.next();
    const WheelState from = plant.state();
    plant.advance(torques.driver + torques.unmeasured, torques.motor, kTickS);
    const WheelState to = plant.state();
    const Cubic angle = Cubic::hermite(from.angle_rad, from.rate_rad_s, to.angle_rad, to.rate_rad_s, kTickS);
    for (int i = 0; i < kReadings; ++i) {
      const double tau_s = i * kReading_s;
      Reading reading;
      reading.true_angle_rad = angle.at(tau_s);
      reading.true_driver_nm = torques.driver.at(tau_s);
      reading.motor_nm = torques.motor.at(tau_s);
      const auto forces = grasp.at(tau_s, reading.true_driver_nm, reading.true_angle_rad);
      for (std::size_t hand = 0; hand < grasp.hands(); ++hand) {
        reading.force[hand] = {transducers.force_n(forces[hand].x_n), transducers.force_n(forces[hand].y_n)};
      }
      reading.angle_rad = transducers.angle_rad(reading.true_angle_rad);
      reading.driver_nm = grasp_moment_nm(settings.hands, reading.force, reading.angle_rad);
      readings.push_back(reading);
    }
  }
  return readings;
}

/// One row of the telemetry: the window around reading `middle`.
Reading through_window(std::span<const Reading> around) {
  static const std::array<double, kWindow> kWeights = hann();
  Reading mean;
  for (std::size_t i = 0; i < kWindow; ++i) {
    const double weight = kWeights[i];
    for (std::size_t hand = 0; hand < 2; ++hand) {
      mean.force[hand].x_n += weight * around[i].force[hand].x_n;
      mean.force[hand].y_n += weight * around[i].force[hand].y_n;
    }
    mean.driver_nm += weight * around[i].driver_nm;
    mean.motor_nm += weight * around[i].motor_nm;
    mean.angle_rad += weight * around[i].angle_rad;
  }
  const Reading& middle = around[kWindow / 2];
  mean.true_driver_nm = middle.true_driver_nm;
  mean.true_angle_rad = middle.true_angle_rad;
  return mean;
}

}  // namespace

Recording make_recording(const RecordingSettings& settings) {
  const Instruments& with = settings.instruments;
  if (!(settings.duration_s >= 1) || with.force_noise_n < 0 || with.angle_noise_rad < 0) {
    throw std::invalid_argument("a recording takes a second or more, and no noise is negative");
  }
  const auto rows = static_cast<std::size_t>(std::llround(settings.duration_s / kTickS));
  const std::vector<Reading> readings = read_drive(settings, rows + 2);  // the window needs a tick at either end
  const bool two = grip_angles(settings.hands).size() == 2;
  Recording out;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t middle = (row + 1) * kReadings;
    const Reading read = through_window(std::span(readings).subspan(middle - kWindow / 2, kWindow));
    out.record.time_s.push_back(static_cast<double>(row) * kTickS);
    out.record.torque_driver_nm.push_back(read.driver_nm);
    out.record.torque_motor_nm.push_back(read.motor_nm);
    out.record.angle_rad.push_back(read.angle_rad);
    out.force[0].push_back(read.force[0]);
    if (two) out.force[1].push_back(read.force[1]);
    out.driver_torque_nm.push_back(read.true_driver_nm);
    out.angle_rad.push_back(read.true_angle_rad);
  }
  return out;
}

}  // namespace steerid
