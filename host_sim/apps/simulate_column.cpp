// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// steerid simulate --task drive: a drive of a whole column as a car's sensors record it, with the truth beside it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "apps/simulate_options.hpp"
#include "backend/simulated_column.hpp"
#include "experiment/hand_positions.hpp"
#include "log/bad_input.hpp"
#include "log/output_folder.hpp"
#include "plant/probe_felt.hpp"
#include "plant/simulation.hpp"
#include "sensors/sensors_json.hpp"

namespace steerid {
namespace {

/// Arm and wheel: those of --sim, else of the average driver who steers, or holds against a disturbance.
WheelArm arm(const SimulateOptions& options) {
  if (options.sim.empty()) {
    return nominal_arm(options.steering_rad > 0 ? TaskKind::kActive : TaskKind::kPassive,
                       chosen(kAllHandPositions, options.hands));
  }
  const Simulation sim = Simulation::load(options.sim);
  if (!sim.effects.empty() || !sim.sensors_json.empty()) {
    throw BadInput(fmt::format(
        "{}: expected the arm and wheel alone for a drive of a whole column, found {}; friction and sensors "
        "of a column belong into the file of --column",
        options.sim.string(), sim.effects.empty() ? "sensors" : "effects"));
  }
  return sim.wheel;
}

ArmChange change(const SimulateOptions& options) {
  ArmChange change{.course = chosen(kAllArmCourses, options.change),
                   .stiffness_nm_per_rad = options.change_to_nm_per_rad.value_or(0),
                   .at_s = options.change_at_s,
                   .length_s = options.change_over_s};
  if ((change.course != ArmCourse::kConstant) != options.change_to_nm_per_rad.has_value()) {
    throw BadOption("--change and --change-to belong together: give how C changes, and to what");
  }
  return change;
}

std::vector<Release> releases(const SimulateOptions& options) {
  std::vector<Release> all;
  for (const auto& [at_s, length_s] : options.releases) all.push_back({at_s, length_s});
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double ready_s = i == 0 ? 0 : all[i - 1].at_s + all[i - 1].length_s + DriveSettings::kReturnS;
    if (all[i].length_s >= DriveSettings::kLeaveS && all[i].at_s >= ready_s) continue;
    throw BadOption(
        fmt::format("--release {:g} {:g}: expected at least {:g} s, and {:g} s after the hands came back "
                    "from the release before",
                    all[i].at_s, all[i].length_s, DriveSettings::kLeaveS, DriveSettings::kReturnS));
  }
  return all;
}

ColumnScenario scenario(const SimulateOptions& options) {
  ColumnScenario scenario;
  if (!options.column.empty()) scenario.column = Column::load(options.column);
  const std::string& stated = scenario.column.sensors_json;
  if (options.noise == "none") {
    scenario.sensors = ColumnSensorDefects::none();
  } else if (!options.noise && !stated.empty()) {
    scenario.sensors = column_sensors_from_json(nlohmann::json::parse(stated), options.column.string());
  }
  DriveSettings& drive = scenario.drive;
  drive.arm = arm(options);
  drive.manoeuvre = chosen(kAllManoeuvres, options.manoeuvre);
  drive.steering_rad = options.steering_rad;
  drive.change = change(options);
  drive.releases = releases(options);
  drive.seed = options.seed;
  const PlannedProbe probe = planned_probe(
      options, {.multisine = {.rms_nm = 1, .high_hz = 6, .random_phases = options.seed}, .duration_s = 60});
  drive.probe = probe.multisine;
  scenario.duration_s = probe.duration_s;
  return scenario;
}

/// What makes the log repeatable, for its head and for the terminal.
std::vector<std::string> description(const SimulateOptions& options, const ColumnScenario& scenario) {
  const Column& column = scenario.column;
  const DriveSettings& drive = scenario.drive;
  const ArmChange& change = drive.change;
  std::string arm = fmt::format("arm        J {:g} kg m2, B {:g} Nms/rad, C {:g} Nm/rad with the wheel",
                                drive.arm.inertia_kgm2, drive.arm.damping_nms_per_rad, drive.arm.stiffness_nm_per_rad);
  if (change.course != ArmCourse::kConstant) {
    arm += fmt::format("; C {} to {:g} Nm/rad from {:g} s on over {:g} s", name(change.course),
                       change.stiffness_nm_per_rad, change.at_s, change.length_s);
  }
  for (const Release& release : drive.releases) {
    arm += fmt::format("; hands off at {:g} s for {:g} s", release.at_s, release.length_s);
  }
  const std::string wheel_friction =
      column.wheel_friction_nm > 0 ? fmt::format(", {:g} Nm above the bar", column.wheel_friction_nm) : "";
  return {
      fmt::format("simulated  drive, {}, {:g} s at 100 Hz, seed {}", options.manoeuvre, scenario.duration_s,
                  options.seed),
      std::move(arm),
      fmt::format("driver     means {:g} rad rms beside the manoeuvre; that torque is in no channel",
                  drive.steering_rad),
      fmt::format("column     {}; bar {:g} Nm/rad, friction {:g} Nm{}, assist {:g} beyond {:g} Nm, road {:g} Nm rms",
                  options.column.empty() ? std::string("the usual one") : printable(options.column.string()),
                  column.bar_stiffness_nm_per_rad, column.rack_friction_nm, wheel_friction, column.assist_gain,
                  column.assist_dead_zone_nm, column.road_rms_nm),
      fmt::format("probe      {:g} Nm rms, {:g} to {:g} Hz; {:.2f} Nm rms of it felt at the rim, but for friction",
                  drive.probe.rms_nm, drive.probe.low_hz, drive.probe.high_hz,
                  felt_of_flat_probe(column, drive.arm, drive.probe.rms_nm, drive.probe.low_hz, drive.probe.high_hz))};
}

void write_truth(const SimulateOptions& options, const ColumnDrive& drive) {
  const auto table = open_table(options.truth, {.what = "truth",
                                                .columns = {"time_s", "inertia_kgm2", "damping_nms_per_rad",
                                                            "stiffness_nm_per_rad", "torque_driver_nm"},
                                                .messages = options.messages});
  for (std::size_t i = 0; i < drive.truth.size(); ++i) {
    const DriveTruth& truth = drive.truth[i];
    table->cell(drive.measured.time_s[i], 6).cell(truth.arm.inertia_kgm2, 7).cell(truth.arm.damping_nms_per_rad, 7);
    table->cell(truth.arm.stiffness_nm_per_rad, 7).cell(truth.torque_driver_nm, 7).end_row();
  }
  table->commit();
}

std::vector<double> torque_driver_nm(const ColumnDrive& drive) {
  std::vector<double> torque;
  for (const DriveTruth& truth : drive.truth) torque.push_back(truth.torque_driver_nm);
  return torque;
}

}  // namespace

void simulate_column(const SimulateOptions& options) {
  const ColumnScenario what = scenario(options);
  check_output_file(options.out);
  if (!options.truth.empty()) check_output_file(options.truth);
  const auto drive = drive_through<ColumnDrive, SimulatedColumnHal>(what);
  const auto lines = description(options, what);
  write_simulated(options,
                  {Channel::kTime, Channel::kTorqueBar, Channel::kTorqueMotor, Channel::kTorqueRim, Channel::kProbe,
                   Channel::kAngle},
                  drive.measured, lines);
  if (!options.truth.empty()) write_truth(options, drive);
  const Record& record = drive.measured;
  fmt::print("{}\n", fmt::join(lines, "\n"));
  fmt::print("rms        driver {:.3f} Nm, bar {:.3f} Nm, rim {:.3f} Nm, motor {:.3f} Nm, angle {:.4f} rad\n",
             rms_of(torque_driver_nm(drive)), rms_of(record.torque_bar_nm), rms_of(record.torque_rim_nm),
             rms_of(record.torque_motor_nm), rms_of(record.angle_rad));
  if (!drive.truth.empty()) {
    const WheelArm& last = drive.truth.back().arm;
    fmt::print("truth      J {:.4g} kg m2, B {:.4g} Nms/rad, C {:.4g} Nm/rad at the end\n", last.inertia_kgm2,
               last.damping_nms_per_rad, last.stiffness_nm_per_rad);
  }
  fmt::print("identified {}, by the firmware's loop along the way\n", estimate_text(drive.estimates.back()));
  fmt::print("log        {}, {} rows\n", printable(options.out.string()), record.size());
  if (!options.truth.empty()) fmt::print("truth      {}\n", printable(options.truth.string()));
}

}  // namespace steerid
