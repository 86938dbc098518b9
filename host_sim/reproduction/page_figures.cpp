// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Figures 5 to 9 of the paper as the experiment finds them.
#include <algorithm>
#include <cmath>

#include "reproduction/conclusions.hpp"
#include "reproduction/page_parts.hpp"

namespace steerid::page {
namespace {

std::vector<double> column(const std::vector<GraspForce>& forces, double GraspForce::*axis) {
  std::vector<double> out;
  for (const GraspForce& force : forces) out.push_back(force.*axis);
  return out;
}

void add_recording(report::Page& page, const Recording& recording, const std::string& title, const std::string& group) {
  const Record& record = recording.record;
  const std::vector<double>& t = record.time_s;
  report::LineChart forces{.title = title + ": forces of the hand on the rim", .x = {"time", "s"}, .y = {"force", "N"}};
  forces.group = group;
  forces.series = {{"F_x, to the right", report::Meaning::kMeasured, t, column(recording.force[0], &GraspForce::x_n)},
                   {"F_y, forward", report::Meaning::kModel, t, column(recording.force[0], &GraspForce::y_n)}};
  report::LineChart torques{.title = title + ": torques", .x = {"time", "s"}, .y = {"torque", "Nm"}};
  torques.group = group;
  torques.series = {{"driver, from the forces", report::Meaning::kTorqueDriver, t, record.torque_driver_nm},
                    {"EPS motor", report::Meaning::kTorqueMotor, t, record.torque_motor_nm}};
  report::LineChart angle{.title = title + ": steering angle", .x = {"time", "s"}, .y = {"angle", "rad"}};
  angle.group = group;
  angle.series = {{"angle", report::Meaning::kMeasured, t, record.angle_rad}};
  page.parts.insert(page.parts.end(), {forces, torques, angle});
}

report::Table grasp_table(const ExperimentResults& results) {
  report::Table out;
  out.title = "The moment reconstructed from F_x and F_y, active task";
  out.caption =
      "M_z = R \u03a3 (cos \u03c6 F_y \u2212 sin \u03c6 F_x), \u03c6 the clock angle of the hand plus the wheel's "
      "angle. The last column "
      "leaves the wheel's angle out, as figure 3 of the paper draws it: the pull towards the hub is then taken for "
      "moment once the wheel has turned.";
  out.columns = {words("hands"), numbers("moment, rms", "Nm", 3), numbers("largest force", "N", 3),
                 numbers("error, rms", "Nm", 2), numbers("error without the angle", "Nm", 2)};
  for (const GraspCheck& one : results.grasps) {
    out.rows.push_back(
        {spoken(one.hands), one.moment_rms_nm, one.largest_force_n, one.error_rms_nm, one.fixed_error_rms_nm});
  }
  return out;
}

Accuracy accuracy_of_task(const std::vector<IdentifiedRecord>& records, TaskKind task) {
  std::vector<IdentifiedRecord> part;
  for (const IdentifiedRecord& record : records) {
    if (record.what.task == task) part.push_back(record);
  }
  return accuracy_of(part);
}

report::Table accuracy_table(const ExperimentResults& results) {
  report::Table out;
  out.title = "Accuracy under 5 Hz, all records";
  out.caption =
      "100 % (1 \u2212 \u03a3 | |Y| \u2212 |\u0176| | / \u03a3 |Y|) over the frequencies up to 5 Hz: of all records "
      "together, and record by "
      "record. \"True J, B, C\" is what the arm that was put in scores on the same records.";
  out.columns = {words("records"),
                 {.label = "all together", .unit = "%"},
                 {.label = "median", .unit = "%"},
                 {.label = "lowest", .unit = "%"},
                 {.label = "true J, B, C: median", .unit = "%"}};
  for (const bool probed : {false, true}) {
    for (const TaskKind task : kSteeringTasks) {
      const Accuracy one = accuracy_of_task(probed ? results.run.probed : results.run.plain, task);
      out.rows.push_back({fmt::format("{}{}", name(task), probed ? ", with probe" : ""), one.pooled_percent,
                          one.percent.median, one.percent.low, one.true_arm_percent.median});
    }
  }
  return out;
}

using Quantity = double (*)(const WheelArm&);

double stiffness(const WheelArm& arm) { return arm.stiffness_nm_per_rad; }
double frequency(const WheelArm& arm) {
  const NaturalFrequency found = natural_frequency(arm);
  return found.defined == NaturalFrequency::Defined::kYes ? found.hz : kNothing;
}

/// A bar a subject and task: median over the six hand positions, whiskers from the least to the largest.
report::Bars by_subject(const ExperimentResults& results, const std::string& title, const report::Axis& value,
                        Quantity quantity) {
  report::Bars chart;
  chart.title = title;
  chart.value = value;
  for (std::size_t subject = 0; subject < kSubjects; ++subject)
    chart.categories.push_back(fmt::format("{}", subject + 1));
  for (const TaskKind task : kSteeringTasks) {
    report::BarSeries series{
        .name = std::string(name(task)),
        .meaning = task == TaskKind::kPassive ? report::Meaning::kStiffness : report::Meaning::kModel};
    for (std::size_t subject = 0; subject < kSubjects; ++subject) {
      std::vector<double> values;
      for (const HandPosition hands : kAllHandPositions) {
        const IdentifiedRecord& record = results.run.probed[ExperimentRun::index(task, hands, subject)];
        const double found = record.batch.all_valid() ? quantity(record.batch.wheel()) : kNothing;
        if (std::isfinite(found)) values.push_back(found);
      }
      const Spread spread = spread_of(values);
      series.values.push_back(spread.count > 0 ? spread.median : kNothing);
      series.low.push_back(spread.count > 0 ? spread.low : kNothing);
      series.high.push_back(spread.count > 0 ? spread.high : kNothing);
    }
    chart.series.push_back(series);
  }
  return chart;
}

report::Scatter found_against_true(const ExperimentResults& results) {
  report::Scatter chart{.title = "Found against true stiffness, as the paper excites",
                        .caption = "Every record; a point a subject, task and hand position.",
                        .x = {"true C", "Nm/rad", true, std::array{3.0, 150.0}},
                        .y = {"found C", "Nm/rad", true, std::array{3.0, 150.0}}};
  chart.identity = true;
  for (const TaskKind task : kSteeringTasks) {
    report::Cloud cloud{.name = std::string(name(task)),
                        .meaning = task == TaskKind::kPassive ? report::Meaning::kStiffness : report::Meaning::kModel};
    for (const IdentifiedRecord& record : results.run.plain) {
      if (record.what.task != task || !record.batch.valid(2)) continue;
      cloud.x.push_back(record.what.arm.stiffness_nm_per_rad);
      cloud.y.push_back(record.batch.value[2]);
    }
    chart.clouds.push_back(cloud);
  }
  return chart;
}

/// The fit over one of the two things that decide it, beside what the true arms score.
report::LineChart fit_chart(const std::vector<FitPoint>& points, const std::string& title, const report::Axis& x,
                            double FitPoint::*over, double scale) {
  report::LineChart chart{.title = title,
                          .caption = fmt::format("Both tasks of {} subjects at 3 o'clock, as the paper excites: all "
                                                 "records together, and the median of what the true arms score.",
                                                 kSweptSubjects),
                          .x = x,
                          .y = {"fit under 5 Hz", "%"}};
  chart.height_px = 220;
  chart.marks = {{report::Mark::Along::kY, kPublishedFit_percent, "the paper: over 97 %"}};
  report::Series found{.name = "identified J, B, C", .meaning = report::Meaning::kModel};
  report::Series truth{.name = "true J, B, C", .meaning = report::Meaning::kPlain, .drawn = report::Drawn::kDashed};
  for (const FitPoint& point : points) {
    found.x.push_back(scale * point.*over);
    found.y.push_back(point.accuracy.pooled_percent);
    truth.x.push_back(scale * point.*over);
    truth.y.push_back(point.accuracy.true_arm_percent.median);
  }
  chart.series = {found, truth};
  return chart;
}

}  // namespace

void add_records(report::Page& page, const ExperimentResults& results) {
  page.parts.push_back(report::Section{"Figures 5 and 6: the records",
                                       "Subject 1. Forces read 1000 times a second and passed on at 100 Hz; the "
                                       "driver's torque is the moment that the forces make."});
  add_recording(page, results.figure_5, "Passive, right arm at 1:30", "figure 5");
  page.parts.push_back(report::Note{"The angle of figure 5", {on_figure_5(results)}, report::Tone::kCaution});
  add_recording(page, results.figure_6, "Active, right arm at 3", "figure 6");
  page.parts.push_back(grasp_table(results));
}

void add_accuracy(report::Page& page, const ExperimentResults& results) {
  page.parts.push_back(report::Section{
      "Figure 7: accuracy",
      fmt::format("Of all records as the paper excites, {}.", on_fit(results.plain_accuracy.pooled_percent))});
  const IdentifiedRecord& record = results.run.plain[ExperimentRun::index(TaskKind::kActive, HandPosition::kRight3, 0)];
  const AmplitudeCurves& curves = record.quality.curves;
  report::LineChart chart{.title = "Amplitude curves, active, right arm at 3",
                          .caption = fmt::format("Subject 1: {:.2f} % under 5 Hz.",
                                                 record.quality.amplitude_fit_percent.value_or(kNothing)),
                          .x = {"frequency", "Hz"},
                          .y = {"amplitude", "rad", true}};
  chart.series = {
      {"measured", report::Meaning::kMeasured, curves.frequency_hz, curves.measured_rad},
      {"identified model", report::Meaning::kModel, curves.frequency_hz, curves.model_rad, {}, report::Drawn::kDashed}};
  page.parts.push_back(chart);
  page.parts.push_back(accuracy_table(results));
  page.parts.push_back(fit_chart(results.fit.over_swing, "The fit over the drift of C (--drift)",
                                 {"drift of C, either way", "%"}, &FitPoint::stiffness_swing, 100));
  page.parts.push_back(fit_chart(results.fit.over_unmeasured, "The fit over the unmeasured torque (--unmeasured)",
                                 {"unmeasured torque, rms of the applied", "%"}, &FitPoint::unmeasured_percent, 1));
  const ExperimentSettings& settings = results.run.settings;
  page.parts.push_back(report::Note{
      "What the fit is a consequence of",
      {fmt::format("Drift and unmeasured torque were put in: {} % and {} %. No model with one C explains either, and "
                   "the true arms score {:.1f} % (median). The two curves show the figure for other choices.",
                   100 * settings.stiffness_swing, settings.unmeasured_percent,
                   results.plain_accuracy.true_arm_percent.median)}});
}

void add_subjects(report::Page& page, const ExperimentResults& results) {
  page.parts.push_back(report::Section{"Figures 8 and 9: subject by subject",
                                       "Bars: median over the six hand positions; whiskers: from the lowest to the "
                                       "highest. Records with the probe."});
  page.parts.push_back(by_subject(results, "Figure 8: stiffness", {"C", "Nm/rad"}, stiffness));
  report::Bars chart = by_subject(results, "Figure 9: natural frequency", {"f", "Hz"}, frequency);
  chart.caption = "Of the records with \u03be < 1 only: a subject without a bar has none whose J, B and C are valid.";
  page.parts.push_back(chart);
  page.parts.push_back(found_against_true(results));
}

}  // namespace steerid::page
