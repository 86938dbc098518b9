// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/labelled_drive.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>

#include "app/run_loop.hpp"
#include "backend/replayed.hpp"
#include "blind/column_drive.hpp"
#include "fit/column_settings.hpp"
#include "identifier/fixed_in_eigen.hpp"
#include "plant/driving_torques.hpp"
#include "sensors/random.hpp"
#include "study/arm_score.hpp"
#include "study/probe_bound.hpp"

namespace steerid {
namespace {

constexpr std::uint64_t kDrawStream = 300;
constexpr double kStrongestDriver_nm = 4;      // rms: who braces does not mean to steer far (docs/theory.md)
constexpr double kLaneKeepingCorner_hz = 0.3;  // experiment/drive_task.hpp

class Draw {
 public:
  Draw(std::uint64_t seed, std::uint64_t number) : random_(seed * 1'000'003 + number, kDrawStream) {}

  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  /// Equally likely in every octave.
  double log_between(double low, double high) { return low * std::pow(high / low, random_.uniform()); }
  bool chance(double share) { return random_.uniform() < share; }
  std::uint64_t seed() { return std::uint64_t{random_.bits()} << 32U | random_.bits(); }

 private:
  Random random_;
};

/// Where plant/column.hpp says that its values come from.
Column drawn_column(Draw& draw) {
  Column column;
  column.wheel_inertia_kgm2 = draw.between(0.026, 0.043);
  column.wheel_damping_nms_per_rad = draw.between(0.03, 0.08);
  column.bar_stiffness_nm_per_rad = draw.between(92, 196);
  column.column_inertia_kgm2 = draw.between(0.06, 0.14);
  column.column_damping_nms_per_rad = draw.between(0.4, 1.2);
  column.aligning_stiffness_nm_per_rad = draw.between(6, 25);
  column.rack_friction_nm = draw.between(0.3, 1.2);
  column.assist_gain = draw.between(0.8, 3.6);
  column.road_rms_nm = draw.log_between(0.03, 0.3);
  return column;
}

ArmChange drawn_change(ArmStory story, const WheelArm& arm, Draw& draw) {
  ArmChange change{.at_s = draw.between(15, 25)};
  const auto to = [&](double factor) { change.stiffness_nm_per_rad = arm.stiffness_nm_per_rad * factor; };
  switch (story) {
    case ArmStory::kStays:
    case ArmStory::kHandsLeave:
      break;
    case ArmStory::kRamps: {
      change.course = draw.chance(0.5) ? ArmCourse::kRamp : ArmCourse::kThereAndBack;
      change.length_s = draw.log_between(2, 20);
      const double factor = draw.log_between(1.33, 3);
      to(draw.chance(0.5) ? factor : 1 / factor);
      break;
    }
    case ArmStory::kSwings:
      change.course = ArmCourse::kSwing;
      change.length_s = draw.log_between(8, 40);
      to(draw.log_between(1.4, 3));
      break;
    case ArmStory::kSecondHand:
      change.course = ArmCourse::kRamp;
      change.length_s = 0.3;
      change.inertia_kgm2 = 1.15 * arm.inertia_kgm2;
      change.damping_nms_per_rad = 1.3 * arm.damping_nms_per_rad;
      to(1.3);
      break;
  }
  return change;
}

blind::ArmCourse course_of(ArmStory story) {
  switch (story) {
    case ArmStory::kStays:
      return blind::ArmCourse::kStays;
    case ArmStory::kRamps:
      return blind::ArmCourse::kChanges;
    case ArmStory::kSwings:
      return blind::ArmCourse::kSwings;
    case ArmStory::kSecondHand:
      return blind::ArmCourse::kSecondHand;
    case ArmStory::kHandsLeave:
      return blind::ArmCourse::kHandsLeave;
  }
  throw std::logic_error("no such story");
}

}  // namespace

std::string_view name(ArmStory story) {
  switch (story) {
    case ArmStory::kStays:
      return "stays";
    case ArmStory::kRamps:
      return "C ramps within 2 to 20 s";
    case ArmStory::kSwings:
      return "C swings, periods of 8 to 40 s";
    case ArmStory::kSecondHand:
      return "a second hand comes";
    case ArmStory::kHandsLeave:
      return "hands leave for 8 to 15 s";
  }
  return "unknown";
}

ColumnScenario drawn_scenario(const DriveRequest& request, std::uint64_t seed, std::uint64_t number) {
  Draw draw(seed, number);
  ColumnScenario scenario;
  scenario.column = drawn_column(draw);
  scenario.column.wheel_friction_nm = request.wheel_friction_nm;
  scenario.duration_s = request.duration_s;
  DriveSettings& drive = scenario.drive;
  const Column& column = scenario.column;
  drive.arm = {column.wheel_inertia_kgm2 + draw.between(0.05, 0.1),
               column.wheel_damping_nms_per_rad + draw.log_between(0.7, 2.2), draw.log_between(6, 60)};
  drive.steering_rad = std::min(request.steering_rad, kStrongestDriver_nm / drive.arm.stiffness_nm_per_rad);
  drive.change = drawn_change(request.story, drive.arm, draw);
  if (request.story == ArmStory::kHandsLeave) {
    drive.releases = {{.at_s = draw.between(15, 25), .length_s = draw.between(8, 15)}};
  }
  drive.seed = draw.seed();
  drive.probe = {.rms_nm = request.probe_nm, .high_hz = 6, .random_phases = draw.seed()};
  ColumnSensorDefects& sensors = scenario.sensors;
  sensors.torque_bar.noise.sd = draw.between(0.015, 0.04);
  sensors.wheel.angle.noise.sd = draw.between(0.0003, 0.0009);
  return scenario;
}

namespace {

/// What the driver's torque, the sensors' noise and the converters' steps hide.
HidingNoise hiding_noise(const ColumnScenario& scenario) {
  const auto with_step = [](const sensor::ChannelDefects& channel) {
    return std::hypot(channel.noise.sd, channel.resolution.step / std::sqrt(12.0));
  };
  return {.intent_rad2_per_hz =
              [rms = scenario.drive.steering_rad](double hz) { return smooth_density(rms, kLaneKeepingCorner_hz, hz); },
          .torque_noise_nm = with_step(scenario.sensors.torque_bar),
          .angle_noise_rad = with_step(scenario.sensors.wheel.angle)};
}

ColumnDrive driven(const ColumnScenario& scenario) {
  ColumnDrive drive;
  SimulatedColumnHal hal(scenario, &drive);
  while (hal.wait_tick() == Status::kOk) {
  }
  return drive;
}

/// The motion that the probe causes, at every tick.
std::vector<double> by_probe_rad(ColumnScenario scenario) {
  scenario.sensors = ColumnSensorDefects::none();
  std::vector<double> z = driven(scenario).undisturbed.angle_rad;
  scenario.column.probe_gain = -scenario.column.probe_gain;
  const std::vector<double> other = driven(scenario).undisturbed.angle_rad;
  for (std::size_t k = 0; k < z.size(); ++k) z[k] = (z[k] - other[k]) / 2;
  return z;
}

}  // namespace

namespace {

constexpr double kDriverSensor_nm = 0.03;

}  // namespace

void know_all_torque(LabelledDrive& drive, std::uint64_t seed, double unseen) {
  constexpr std::uint64_t kNoiseStream = 301;
  Record& record = drive.record;
  Random random(seed, kNoiseStream);
  record = with_driving_torques(std::move(record));
  record.probe_nm.clear();
  record.channels = kAllChannelsValid;
  for (std::size_t k = 0; k < record.size(); ++k) {
    record.torque_driver_nm[k] = (1 - unseen) * drive.voluntary_nm[k] + kDriverSensor_nm * random.normal();
  }
}

LabelledDrive drive_of(const ColumnScenario& scenario, Known known, Bound bound) {
  ColumnDrive driven_so = driven(scenario);
  LabelledDrive drive;
  drive.record = std::move(driven_so.measured);
  for (const DriveTruth& truth : driven_so.truth) {
    drive.truth.push_back(truth.arm);
    drive.voluntary_nm.push_back(truth.torque_driver_nm);
  }
  if (known == Known::kAllTorque) {
    know_all_torque(drive, scenario.drive.seed);
    HidingNoise noise = hiding_noise(scenario);
    noise.intent_rad2_per_hz = [](double) { return 0.0; };
    noise.torque_noise_nm = std::hypot(noise.torque_noise_nm, kDriverSensor_nm);
    drive.information = probe_information(driven_so.undisturbed.angle_rad, drive.truth, noise, LabelledDrive::kBlock);
  } else if (bound == Bound::kWithInformation) {
    drive.information =
        probe_information(by_probe_rad(scenario), drive.truth, hiding_noise(scenario), LabelledDrive::kBlock);
  }
  return drive;
}

LabelledDrive labelled(blind::DrawnColumnDrive& drawn) {
  LabelledDrive drive;
  drive.record = std::move(drawn.record);
  for (const blind::ColumnTruth& truth : drawn.truth) {
    drive.truth.push_back({truth.inertia_kgm2, truth.damping_nms_per_rad, truth.stiffness_nm_per_rad});
    drive.voluntary_nm.push_back(truth.voluntary_nm);
  }
  return drive;
}

LabelledDrive held_out_drive(const DriveRequest& request, std::uint64_t seed, std::uint64_t number) {
  blind::DrawnColumnDrive drawn = blind::draw_column_drive({.course = course_of(request.story),
                                                            .steering_rad = request.steering_rad,
                                                            .probe_nm = request.probe_nm,
                                                            .duration_s = request.duration_s,
                                                            .wheel_friction_nm = request.wheel_friction_nm},
                                                           seed, number);
  LabelledDrive drive = labelled(drawn);
  drive.information = probe_information(drawn.by_probe_rad, drive.truth,
                                        {.intent_rad2_per_hz = drawn.intent_rad2_per_hz,
                                         .torque_noise_nm = drawn.torque_noise_nm,
                                         .angle_noise_rad = drawn.angle_noise_rad},
                                        LabelledDrive::kBlock);
  return drive;
}

template <class Scalar>
std::vector<Estimate> estimates_of(const Record& record, double wheel_friction_nm) {
  ReplayedHal hal(record);
  const ClosedLoopSettings<Scalar> column = column_with_friction<Scalar>(wheel_friction_nm);
  IdentificationTask<Scalar> task(kSteeringWheel<Scalar>, InputSupervision::kSteeringWheel, Probe::kGentle, column);
  if (run_loop(hal, task) != Status::kOk) throw std::logic_error("a replayed record ended otherwise than by its end");
  std::vector<Estimate> by_row;
  std::size_t tick = 0;
  for (std::size_t row = 0; row < record.size(); ++row) {
    const std::int64_t stamp_us = std::llround((record.time_s[row] - record.time_s.front()) * 1e6);
    while (tick + 1 < hal.times_us().size() && hal.times_us()[tick] < stamp_us) ++tick;
    by_row.push_back(hal.estimates()[tick]);
  }
  return by_row;
}

template std::vector<Estimate> estimates_of<float>(const Record&, double);
template std::vector<Estimate> estimates_of<double>(const Record&, double);
template std::vector<Estimate> estimates_of<Fixed>(const Record&, double);

std::vector<Estimate> estimates_tick_by_row(const Record& record) {
  const ReplayedHal rows(record);
  IdentificationTask<float> task;
  std::vector<Estimate> by_row;
  for (std::size_t row = 0; row < record.size(); ++row) {
    task.take(rows.sample_of(row));
    by_row.push_back(task.estimate());
  }
  return by_row;
}

double differing_percent(const std::vector<Estimate>& one, const std::vector<Estimate>& other) {
  std::int64_t differing = 0;
  for (std::size_t k = 0; k < one.size(); ++k) {
    const auto a = parameters_of(one[k]);
    const auto b = parameters_of(other[k]);
    bool differs = false;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const std::int64_t apart = std::abs(std::int64_t{a[i].value_micro} - b[i].value_micro);
      differs = differs || a[i].state != b[i].state || 10 * apart > a[i].sd_micro;
    }
    differing += differs;
  }
  return ParameterTicks::percent(differing, static_cast<std::int64_t>(one.size()));
}

Eigen::Vector3d walk_of(const std::vector<WheelArm>& truth) {
  constexpr std::size_t kSecond = 100;  // rows
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = kSecond; k < truth.size(); ++k) {
    const auto now = parameters_of(truth[k]);
    const auto before = parameters_of(truth[k - kSecond]);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double went = now[i] - before[i];
      sum(static_cast<Eigen::Index>(i)) += went * went;
    }
  }
  const auto steps = static_cast<double>(truth.size() - kSecond);
  return sum / steps * (static_cast<double>(LabelledDrive::kBlock) / kSecond);
}

}  // namespace steerid
