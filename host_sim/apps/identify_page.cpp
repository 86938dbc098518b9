// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/identify_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "apps/channel_words.hpp"
#include "log/reading_time.hpp"
#include "report/uncertainty.hpp"

namespace steerid {
namespace {

report::ParameterAnswer shown(const IdentifiedParameter& parameter) {
  return {parameter.value, parameter.sd, name(parameter.state)};
}

report::ParameterTrace trace_of(const FirmwareRun& run, std::span<const double> time_s,
                                const ParameterEstimate Estimate::*which) {
  report::ParameterTrace trace;
  for (const Estimate& estimate : run.estimates) {
    const IdentifiedParameter parameter = from_published(estimate.*which, run.units.parameter());
    trace.value.push_back(parameter.value);
    trace.sd.push_back(parameter.sd);
  }
  trace.states = report::state_spans(time_s, [&](std::size_t i) { return name((run.estimates[i].*which).state); });
  return trace;
}

std::vector<double> unless_zero(const std::vector<double>& channel) {
  const bool absent = std::all_of(channel.begin(), channel.end(), [](double value) { return value == 0.0; });
  return absent ? std::vector<double>{} : channel;
}

/// Without a full stop; empty where the free run says it.
std::string driven_words(const Identification& found) {
  if (voluntary_torque_known(found.equation)) return "";
  if (!found.unmeasured_torque_nm) return "No probe drives the wheel: the driver's own torque is not known";
  const std::string unmeasured =
      fmt::format("the torque that no sensor explains is {:.2g} Nm rms", *found.unmeasured_torque_nm);
  if (!found.driven) return "The" + unmeasured.substr(3);
  return fmt::format(
      "Of the torque that the probe drives this arm misses {:.2g} %, where noise alone makes {:.2g} %; {}",
      100 * found.driven->nrmse, 100 * found.driven->by_noise, unmeasured);
}

std::string own_words(const IdentifiedParameter& parameter, const char* unit) {
  if (!is_identified(parameter.state)) return name(parameter.state);
  return fmt::format("{} {}", report::with_sd(parameter.value, parameter.sd), unit);
}

void fill_parameters(const IdentifyPageInput& input, report::IdentifyReport& page) {
  struct Row {
    report::IdentifiedParameter& shown_as;
    IdentifiedParameter Identification::*found;
    const ParameterEstimate Estimate::*published;
  };
  for (const Row& row : {Row{page.inertia, &Identification::inertia_kgm2, &Estimate::inertia},
                         Row{page.damping, &Identification::damping_nms_per_rad, &Estimate::damping},
                         Row{page.stiffness, &Identification::stiffness_nm_per_rad, &Estimate::stiffness}}) {
    row.shown_as.recursive = shown(input.recursive.found.*row.found);
    if (input.batch) row.shown_as.batch = shown(input.batch->found.*row.found);
    row.shown_as.trace = trace_of(input.run, page.trace_time_s, row.published);
  }
}

}  // namespace

report::Page identify_page(const IdentifyPageInput& input) {
  report::IdentifyReport page;
  page.record_name = input.record_name;
  page.subtitle = fmt::format("{}. Equation: {}", input.subtitle, equation_words(input.recursive.found.equation));
  const double zero_s = reading_zero_s(input.record.time_s.front());
  page.time_s = reading_times(input.record.time_s, zero_s);
  page.torque_driver_nm = unless_zero(input.record.torque_driver_nm);
  page.torque_motor_nm = unless_zero(input.record.torque_motor_nm);
  page.torque_bar_nm = input.record.torque_bar_nm;
  page.torque_rim_nm = input.record.torque_rim_nm;
  page.angle_rad = input.record.angle_rad;
  page.trace_time_s = reading_times(input.run.time_s, zero_s);
  fill_parameters(input, page);

  for (const DriverSpan& span : input.driver.spans) {
    page.driver.push_back({span.from_s - zero_s, span.to_s - zero_s, name(span.state), name(span.hands)});
  }

  if (input.over_time && !input.over_time->time_s.empty()) {
    const VaryingArm& arm = *input.over_time;
    const std::vector<double> time_s = reading_times(arm.time_s, zero_s);
    if (arm.inertia_changes()) page.inertia.smoothed = {time_s, arm.inertia.value, arm.inertia.sd};
    page.damping.smoothed = {time_s, arm.damping.value, arm.damping.sd};
    page.stiffness.smoothed = {time_s, arm.stiffness.value, arm.stiffness.sd};
  }

  const FrequencyAnswer frequency = frequency_answer(input.recursive.found);
  page.natural_frequency_hz = frequency.hz;
  page.natural_frequency_reason = frequency.reason;
  page.damping_ratio = frequency.damping_ratio;
  page.free_run_angle_rad = input.recursive.free_run_rad;
  page.free_run_nrmse = input.recursive.found.free_run_nrmse;
  page.fit_sentence = driven_words(input.recursive.found);
  if (input.recursive.found.amplitude_fit_percent) {
    page.amplitude = report::AmplitudeCurves{input.recursive.curves.frequency_hz, input.recursive.curves.measured_rad,
                                             input.recursive.curves.model_rad,
                                             *input.recursive.found.amplitude_fit_percent, kAmplitudeFitLimit_hz};
  }
  if (!input.driver.none_since.empty()) {
    page.notes.push_back({"The driver",
                          {fmt::format("Nothing is told of a driver: {}.", input.driver.none_since)},
                          report::Tone::kNeutral});
  }
  if (input.own_arm) {
    const OwnArm& own = *input.own_arm;
    page.notes.push_back(
        {"The driver's own arm",
         {fmt::format("Less the wheel of {}, the driver's own arm has J {}, B {}.", own.wheel.from,
                      own_words(own.inertia_kgm2, "kg m\u00b2"), own_words(own.damping_nms_per_rad, "Nms/rad"))},
         report::Tone::kNeutral});
  }
  const Credibility& credibility = input.credibility;
  if (credibility.credible == false) {
    page.refused = credibility.reasons;
  } else {
    page.cautions = credibility.reasons;
  }
  if (!credibility.next.empty()) page.notes.push_back({"Next", {credibility.next}, report::Tone::kNeutral});
  std::vector<std::string> notes = input.notes;
  if (input.recursive.found.wheel) {
    const WheelBetween& wheel = *input.recursive.found.wheel;
    const bool good = wheel.verdict == WheelBetween::Verdict::kAgree;
    const std::string words = wheel_words(wheel);
    std::erase(notes, words);  // it has a place of its own
    page.notes.push_back({"The two sensors", {words}, good ? report::Tone::kGood : report::Tone::kCaution});
  }
  if (!notes.empty()) page.notes.push_back({"About the record", notes, report::Tone::kNeutral});
  return report::identify_page(page);
}

}  // namespace steerid
