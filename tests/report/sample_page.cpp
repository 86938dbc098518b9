// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Writes the pages that the browser test opens: one with every kind of part and the strings and numbers that break
// careless pages, and one identification.
//
//   report_sample_page FOLDER
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "report/identify_report.hpp"
#include "report/page.hpp"

namespace {

using namespace steerid::report;  // NOLINT(google-build-using-namespace): a page is a long list of its types

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const std::string kAwkward =
    "</script><img src=x onerror=alert(1)> & <!-- \" ' ` ${x} \u2028 \xff \u03b8\u0308 $& \\u003c";

std::vector<double> sampled(std::size_t count, double step, double (*f)(double)) {
  std::vector<double> out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = f(step * static_cast<double>(i));
  return out;
}

std::vector<double> ramp(std::size_t count, double step) {
  return sampled(count, step, [](double t) { return t; });
}

Page every_part() {
  const std::size_t many = 100'000;
  const std::vector<double> time = ramp(many, 0.01);
  std::vector<double> wave = sampled(many, 0.01, [](double t) { return std::sin(t) + 0.2 * std::sin(37 * t); });
  for (std::size_t i = 30'000; i < 34'000; ++i) wave[i] = kNan;
  wave[50'000] = std::numeric_limits<double>::infinity();
  const std::vector<double> slow = sampled(many, 0.01, [](double t) { return std::cos(t / 40); });
  const std::vector<double> sd = sampled(many, 0.01, [](double t) { return 0.05 + 0.6 * std::exp(-t / 60); });
  const std::vector<double> hz = sampled(60, 1, [](double i) { return 0.1 * std::pow(1.1, i); });
  const std::vector<double> gain =
      sampled(60, 1, [](double i) { return 1 / (1 + std::pow(0.1 * std::pow(1.1, i), 2)); });

  Page page{.title = "Every part of a report, " + kAwkward, .subtitle = kAwkward, .parts = {}, .footer = kAwkward};
  page.parts = {
      Headline{"The part that answers first: " + kAwkward,
               Tone::kGood,
               {{"Inertia J", "0.1103", "kg m\u00b2", "\u00b1 0.0012", "valid", Meaning::kInertia},
                {"Damping B", "1.498", "Nms/rad", "\u00b1 0.021", "holding", Meaning::kDamping},
                {"A label that is rather long for a small column", "none", "", kAwkward, "not excited", {}}}},
      Section{"Words " + kAwkward, "A lead below a heading."},
      Note{"A caution", {"First paragraph. " + kAwkward, "Second paragraph."}, Tone::kCaution},
      Note{"Bad news",
           {"averyveryverylongwordwithoutanyplacetobreakitaveryveryverylongwordwithoutanyplacetobreakit"},
           Tone::kBad},
      Table{"Numbers, states and gaps",
            "All kinds of cells. " + kAwkward,
            {{"Parameter", "", false, 4},
             {"Value", "Nm/rad", true, 5},
             {"State", "", false, 4},
             {"Text", "", true, 4},
             {"Tiny", "m", true, 3},
             {"Huge", "", true, 3}},
            {{"C", 22.70123, Badge{"valid"}, "1.2 \u00b1 0.1", 1.5e-9, 3e12},
             {"B", -1.5, Badge{"converging"}, "", 0.0, -0.00012},
             {kAwkward, kNan, Badge{"fault"}, kAwkward, std::numeric_limits<double>::infinity(), 12345.6}}},
      Section{"Charts", ""},
      LineChart{.title = "A long series with gaps, a band and states",
                .caption = kAwkward,
                .x = {"Time", "s"},
                .y = {"Value", "rad"},
                .series = {{"wave", Meaning::kMeasured, time, wave}, {"slow", Meaning::kStiffness, time, slow, sd}},
                .states = {{0, 60, "starting"},
                           {60, 200, "converging"},
                           {200, 700, "valid"},
                           {700, 900, "holding"},
                           {900, 950, "fault"},
                           {950, 999.99, "not excited"}},
                .marks = {{Mark::Along::kX, 400, "a mark", Meaning::kReference}},
                .regions = {{800, 1000, "held out"}},
                .group = "time"},
      LineChart{.title = "Its companion",
                .caption = "",
                .x = {"Time", "s"},
                .y = {"Torque", "Nm"},
                .series = {{kAwkward, Meaning::kTorqueDriver, time, slow}, {"motor", Meaning::kTorqueMotor, time, sd}},
                .group = "time"},
      LineChart{.title = "Two logarithmic axes",
                .caption = "",
                .x = {"Frequency", "Hz", true},
                .y = {"Gain", "", true},
                .series = {{"measured", Meaning::kMeasured, hz, gain, {}, Drawn::kPoints},
                           {"model", Meaning::kModel, hz, gain, {}, Drawn::kDashed}}},
      LineChart{.title = "A line without a value",
                .caption = "",
                .x = {"Time", "s"},
                .y = {"Value", ""},
                .series = {{"nothing", Meaning::kPlain, {}, {}}}},
      Scatter{.title = "A cloud",
              .caption = "",
              .x = {"Said", "Nm/rad"},
              .y = {"Found", "Nm/rad"},
              .clouds = {{"passive",
                          Meaning::kModel,
                          {13, 22, 41, 80, kNan},
                          {13.4, 21.5, 40.2, 78, 3},
                          {"right_3", "right_12", kAwkward, "both_3_9", "lost"}},
                         {"active", Meaning::kInertia, {4.5, 7, 13}, {4.4, 7.4, 12.1}}},
              .identity = true},
      Heatmap{.title = "Which is taken for which",
              .caption = "",
              .x_label = "said",
              .y_label = "true",
              .columns = {"none", "parameters", "coulomb_friction", "delay", "unknown"},
              .rows = {"none", "parameters", "coulomb_friction", kAwkward},
              .values = {{1, 0, 0, 0, 0}, {0.1, 0.8, 0, 0, 0.1}, {0, 0, 0.97, 0, 0.03}, {0, kNan, 0.2, 0.8, 0}},
              .value = {"share", ""},
              .digits = 2},
      Heatmap{.title = "A difference",
              .caption = "",
              .x_label = "hands",
              .y_label = "task",
              .columns = {"right_3", "right_12"},
              .rows = {"passive", "active"},
              .values = {{-3, 2}, {1, 0.5}},
              .value = {"change", "%"},
              .diverging = true},
      Bars{.title = "Bars with intervals",
           .caption = "",
           .categories = {"coulomb_friction", "presliding_hysteresis", "a category with a rather long name", kAwkward},
           .value = {"Closed", "%"},
           .series = {{"with effect", Meaning::kModel, {95, 81, 40, kNan}, {93, 70, 20, kNan}, {97, 88, 61, kNan}},
                      {"refit", Meaning::kReference, {20, 31, 12, 4}}}},
      Histogram{.title = "Normalised errors",
                .caption = "",
                .x = {"error / sd", ""},
                .name = "runs",
                .meaning = Meaning::kPlain,
                .edges = {-3, -2, -1, -0.5, 0, 0.5, 1, 2, 3},
                .counts = {2, 14, 15, 19, 20, 14, 13, 3},
                .expected_name = "normal",
                .expected = {2.1, 13.6, 15, 19.1, 19.1, 15, 13.6, 2.1}},
  };
  return page;
}

/// Wheel and arm driven by a multisine, integrated here by small steps; estimates that settle as estimates do.
Page identification() {
  constexpr double kJ = 0.11;
  constexpr double kB = 1.5;
  constexpr double kC = 22.7;
  constexpr std::size_t kSamples = 6000;
  constexpr int kSteps = 20;
  constexpr double kStep = 0.01 / kSteps;
  std::mt19937 noise(7);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same page every time
  const auto uniform = [&] { return static_cast<double>(noise()) / 4294967296.0 - 0.5; };
  const auto motor = [](double t) {
    double sum = 0;
    for (int k = 1; k <= 12; ++k) sum += 0.45 * std::sin(2 * std::numbers::pi * 0.31 * k * t + 1.7 * k * k);
    return sum;
  };

  IdentifyReport report;
  report.record_name = "drive.csv";
  report.subtitle = "60.0 s at 100 Hz, 6,000 samples. Recursive estimator in float, batch Gauss-Newton beside it.";
  double angle = 0;
  double rate = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double t = 0.01 * static_cast<double>(i);
    report.time_s.push_back(t);
    report.torque_motor_nm.push_back(motor(t));
    report.torque_driver_nm.push_back(0.3 * std::sin(0.4 * t));
    report.free_run_angle_rad.push_back(angle);
    report.angle_rad.push_back(angle + 0.004 * uniform() + 0.003 * std::sin(0.9 * t));
    for (int s = 0; s < kSteps; ++s) {
      const double at = t + kStep * s;
      rate += kStep * (0.3 * std::sin(0.4 * at) - motor(at) - kB * rate - kC * angle) / kJ;
      angle += kStep * rate;
    }
  }
  report.trace_time_s = report.time_s;
  const auto settle = [&](IdentifiedParameter& parameter, double truth, double speed, double valid_s) {
    for (const double t : report.time_s) {
      const double sd = truth * (0.004 + 1.4 * std::exp(-speed * t));
      parameter.trace.value.push_back(truth + sd * 0.8 * std::cos(0.7 * t));
      parameter.trace.sd.push_back(sd);
    }
    parameter.trace.states = state_spans(report.time_s, [&](std::size_t i) {
      const double t = report.time_s[i];
      return t < 0.5 ? "starting" : t < valid_s ? "converging" : t > 40 && t < 47 ? "holding" : "valid";
    });
    parameter.recursive = {parameter.trace.value.back(), parameter.trace.sd.back(), "valid"};
    parameter.batch = ParameterAnswer{truth * 1.001, truth * 0.003, "valid"};
  };
  settle(report.inertia, kJ, 0.5, 9);
  settle(report.damping, kB, 0.6, 7.5);
  settle(report.stiffness, kC, 0.9, 4.5);
  report.stiffness.published = 22.0;
  report.natural_frequency_hz = 2.04;
  report.damping_ratio = 0.475;
  report.free_run_nrmse = 0.021;
  AmplitudeCurves curves;
  for (int k = 1; k <= 200; ++k) {
    const double f = 0.025 * k;
    const double w = 2 * std::numbers::pi * f;
    const double amplitude = 0.45 / std::hypot(kC - kJ * w * w, kB * w);
    curves.frequency_hz.push_back(f);
    curves.model.push_back(amplitude);
    curves.measured.push_back(amplitude * (1 + 0.05 * uniform()));
  }
  curves.fit_percent = 97.8;
  report.amplitude = curves;
  report.notes = {
      {"What was left out", {"14 samples were turned down: 12 repeated stamps, 2 spikes."}, Tone::kCaution}};
  return identify_page(report);
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) {
    (void)std::fputs("usage: report_sample_page FOLDER\n", stderr);
    return 2;
  }
  const std::filesystem::path folder = words[1];
  std::filesystem::create_directories(folder);
  write_page(folder / "every_part.html", every_part());
  write_page(folder / "identification.html", identification());
  write_page(folder / "empty.html", Page{.title = "Empty", .subtitle = "", .parts = {}});
}
