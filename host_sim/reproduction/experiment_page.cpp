// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The page of the experiment: the answer in a sentence, then section by section in the paper's order.
#include <algorithm>

#include "reproduction/conclusions.hpp"
#include "reproduction/experiment_files.hpp"
#include "reproduction/page_parts.hpp"

namespace steerid {
namespace {

report::Headline headline(const ExperimentResults& results) {
  const auto inertia_error = [](const std::vector<IdentifiedRecord>& records) {
    const std::array<MeasuredErrors, 2> errors = batch_errors(records);
    return std::max(errors[0].rms[0], errors[1].rms[0]);
  };
  report::Headline head;
  for (const std::string& sentence : conclusions(results)) head.verdict += (head.verdict.empty() ? "" : " ") + sentence;
  constexpr std::array<std::size_t, 1> kStiffness{2};
  constexpr std::array<std::size_t, 3> kAll{0, 1, 2};
  const bool as_hoped = results.plain_accuracy.pooled_percent > kPublishedFit_percent &&
                        right(batch_errors(results.run.plain), kStiffness) &&
                        right(batch_errors(results.run.probed), kAll);
  head.tone = as_hoped ? report::Tone::kNeutral : report::Tone::kCaution;
  head.numbers = {
      {.label = "Amplitude fit, as the paper excites",
       .value = fmt::format("{:.2f}", results.plain_accuracy.pooled_percent),
       .unit = "%",
       .note = fmt::format("median record {:.2f}, true J, B, C {:.2f}", results.plain_accuracy.percent.median,
                           results.plain_accuracy.true_arm_percent.median)},
      {.label = "Error of J without a probe",
       .value = fmt::format("{:.1f}", 100 * inertia_error(results.run.plain)),
       .unit = "%",
       .note = "rms, the worse task",
       .meaning = report::Meaning::kInertia},
      {.label = fmt::format("Error of J with {} Nm rms", results.run.settings.probe_rms_nm),
       .value = fmt::format("{:.2f}", 100 * inertia_error(results.run.probed)),
       .unit = "%",
       .note = "rms, the worse task",
       .meaning = report::Meaning::kInertia},
      {.label = "Driver's state told wrong",
       .value = fmt::format("{:.1f}", 100 * results.driver_probed.wrong_share(results.driver_probed.state_settled)),
       .unit = "%",
       .note = "of the told time, 5 s after a change"}};
  return head;
}

}  // namespace

report::Page experiment_page(const ExperimentResults& results) {
  report::Page out;
  out.title = "The paper's experiment, reproduced";
  out.subtitle =
      "Lv et al., Characterization of Driver Neuromuscular Dynamics for Human-Automation Collaboration Design of "
      "Automated Vehicles, 2018";
  out.parts.push_back(headline(results));
  page::add_put_in(out, results);
  page::add_tables(out, results);
  page::add_records(out, results);
  page::add_accuracy(out, results);
  page::add_subjects(out, results);
  page::add_correlations(out, results);
  page::add_excitation(out, results);
  page::add_contradictions(out, results);
  page::add_convergence(out, results);
  page::add_driver_state(out, results);
  const ExperimentSettings& settings = results.run.settings;
  out.footer = fmt::format(
      "steerid experiment --seed {} --probe {}; passive {} s, active {} s, C drifts by {} % either way, unmeasured "
      "torque {} % of the applied",
      settings.seed, settings.probe_rms_nm, settings.passive_s, settings.active_s, 100 * settings.stiffness_swing,
      settings.unmeasured_percent);
  return out;
}

}  // namespace steerid
