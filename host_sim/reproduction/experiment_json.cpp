// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// experiment.json. Numbers that do not exist (no natural frequency, an infinite bound) are null.
#include <cmath>
#include <nlohmann/json.hpp>

#include "reproduction/conclusions.hpp"
#include "reproduction/experiment_files.hpp"

namespace steerid {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kParameters{"inertia_kgm2", "damping_nms_per_rad", "stiffness_nm_per_rad"};
constexpr std::array kFour{"inertia_kgm2", "damping_nms_per_rad", "stiffness_nm_per_rad", "natural_frequency_hz"};

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json three(const std::array<double, 3>& values) {
  Json json;
  for (std::size_t i = 0; i < 3; ++i) json[kParameters[i]] = number(values[i]);
  return json;
}

Json arm_json(const WheelArm& arm) {
  return three({arm.inertia_kgm2, arm.damping_nms_per_rad, arm.stiffness_nm_per_rad});
}

Json spread_json(const Spread& spread) {
  if (spread.count == 0) return {{"count", 0}, {"nominal", nullptr}, {"range", nullptr}};
  return {{"count", spread.count}, {"nominal", spread.median}, {"range", {spread.low, spread.high}}};
}

Json four_json(const FourSpreads& spreads) {
  Json json;
  for (std::size_t i = 0; i < 4; ++i) json[kFour[i]] = spread_json(spreads[i]);
  return json;
}

Json published_json(const PublishedRow& row) {
  Json json;
  const std::array ranges{row.inertia_kgm2, row.damping_nms_per_rad, row.stiffness_nm_per_rad,
                          row.natural_frequency_hz};
  for (std::size_t i = 0; i < 4; ++i) {
    json[kFour[i]] = {{"nominal", ranges[i].nominal}, {"range", {ranges[i].low, ranges[i].high}}};
  }
  return json;
}

Json tables_json(const ExperimentResults& results) {
  Json tables = Json::array();
  for (const TableRow& row : results.rows) {
    tables.push_back(
        {{"table", row.task == TaskKind::kPassive ? "I" : "II"},
         {"task", name(row.task)},
         {"hands", name(row.hands)},
         {"paper", both_arms(row.hands) ? Json(nullptr) : published_json(published_row(row.task, row.hands))},
         {"true", four_json(row.truth)},
         {"batch_as_in_the_paper", four_json(row.plain)},
         {"batch_with_probe", four_json(row.probed)},
         {"recursive_with_probe", four_json(row.recursive_probed)},
         {"overdamped_true", row.overdamped_truth},
         {"overdamped_batch_with_probe", row.overdamped_probed}});
  }
  return tables;
}

Json answer_json(const ArmAnswer& answer) {
  Json json;
  for (std::size_t i = 0; i < 3; ++i) {
    json[kParameters[i]] = {{"value", answer.value[i]}, {"sd", number(answer.sd[i])}, {"state", name(answer.state[i])}};
  }
  const std::optional<NaturalFrequency> frequency = answer.frequency();
  const bool defined = frequency && frequency->defined == NaturalFrequency::Defined::kYes;
  json["natural_frequency_hz"] = {{"value", defined ? Json(frequency->hz) : Json(nullptr)},
                                  {"reason", frequency ? frequency->reason() : "a parameter is not valid"}};
  return json;
}

/// Figures 8 and 9: one entry a record.
Json records_json(const std::vector<IdentifiedRecord>& records) {
  Json json = Json::array();
  for (const IdentifiedRecord& record : records) {
    json.push_back({{"subject", record.subject + 1},
                    {"task", name(record.what.task)},
                    {"hands", name(record.what.hands)},
                    {"probe_rms_nm", record.what.probe_rms_nm},
                    {"true", arm_json(record.what.arm)},
                    {"true_damping_ratio", number(record.what.arm.damping_ratio())},
                    {"batch", answer_json(record.batch)},
                    {"recursive", answer_json(record.recursive)},
                    {"driver_state", name(record.driver)},
                    {"amplitude_fit_percent", number(record.quality.amplitude_fit_percent)},
                    {"free_run_nrmse", number(record.quality.free_run_nrmse)},
                    {"convergence_factor", number(record.convergence_factor)}});
  }
  return json;
}

Json accuracy_json(const Accuracy& accuracy) {
  return {{"pooled_percent", accuracy.pooled_percent},
          {"median_percent", accuracy.percent.median},
          {"lowest_percent", accuracy.percent.low},
          {"true_arm_median_percent", accuracy.true_arm_percent.median},
          {"records", accuracy.percent.count}};
}

Json association_json(const Association& one, double holm_p, const char* coefficient) {
  return {{coefficient, one.coefficient}, {"p", one.p}, {"p_holm", holm_p}, {"significant", holm_p < kSignificance}};
}

Json effect_json(const LabelCorrelation& one) {
  const RepeatedMeasures& effect = one.effect;
  if (!effect.tested()) return {{"subjects", effect.subjects}, {"f", nullptr}};
  return {{"subjects", effect.subjects},
          {"f", effect.f},
          {"degrees_of_freedom", {effect.between(), effect.within()}},
          {"epsilon", effect.epsilon},
          {"p", effect.p},
          {"p_holm", one.effect_holm_p},
          {"significant", one.effect_holm_p < kSignificance},
          {"partial_eta_squared", effect.partial_eta_squared},
          {"level_means", effect.level_mean}};
}

Json put_in_json(const ExperimentResults& results) {
  Json json = Json::array();
  for (const PutIn& one : results.put_in) {
    json.push_back({{"what", one.what},
                    {"unit", one.unit},
                    {"comes_from", one.origin},
                    {"put_in", spread_json(one.truth)},
                    {"batch_as_in_the_paper", spread_json(one.plain)},
                    {"batch_with_probe", spread_json(one.probed)}});
  }
  return json;
}

Json fit_points_json(const std::vector<FitPoint>& points) {
  Json json = Json::array();
  for (const FitPoint& point : points) {
    Json one = {{"stiffness_swing", point.stiffness_swing}, {"unmeasured_percent", point.unmeasured_percent}};
    one.update(accuracy_json(point.accuracy));
    json.push_back(one);
  }
  return json;
}

Json correlations_json(const ExperimentResults& results) {
  Json json = Json::array();
  for (const LabelCorrelation& one : results.correlations) {
    Json plain = association_json(one.plain, one.holm_p, "r");
    plain["p_benjamini_hochberg"] = one.benjamini_hochberg_p;
    json.push_back({{"label", kLabels[one.label]},
                    {"quantity", kQuantities[one.quantity]},
                    {"records", one.records},
                    {"pearson", plain},
                    {"all_else_equal", association_json(one.paired, one.paired_holm_p, "r")},
                    {"between_classes", association_json(one.ratio, one.ratio_holm_p, "eta_squared")},
                    {"repeated_measures", effect_json(one)}});
  }
  return json;
}

Json excitation_json(const ExperimentResults& results) {
  Json json = Json::array();
  for (const ExcitationRow& row : results.excitation) {
    Json bounds = Json::array();
    for (std::size_t i = 0; i < row.probe_rms_nm.size(); ++i) {
      Json bound = three(row.relative_sd[i]);
      bound["probe_rms_nm"] = row.probe_rms_nm[i];
      bounds.push_back(bound);
    }
    Json least;
    for (std::size_t i = 0; i < 3; ++i) least[kParameters[i]] = number(row.least_probe_nm[i]);
    json.push_back({{"performed", row.performed == Performed::kToTheLetter ? "to the letter" : "by a driver"},
                    {"task", name(row.task)},
                    {"hands", name(row.hands)},
                    {"relative_cramer_rao_sd", bounds},
                    {"least_probe_rms_nm", least}});
  }
  return json;
}

Json errors_json(const ExperimentResults& results) {
  Json json = Json::array();
  for (const ErrorRow& row : error_rows(results.run)) {
    json.push_back({{"task", name(row.task)},
                    {"probe_rms_nm", row.probed ? results.run.settings.probe_rms_nm : 0.0},
                    {"method", row.batch ? "batch_gauss_newton" : "recursive"},
                    {"relative_bias", three(row.errors.bias)},
                    {"relative_rms_error", three(row.errors.rms)},
                    {"valid_share", three(row.errors.valid_share)},
                    {"covered_share_of_valid", three(row.errors.covered)}});
  }
  return json;
}

Json sweep_json(const ExperimentResults& results) {
  Json json = Json::array();
  for (const SweepPoint& point : results.sweep) {
    json.push_back({{"task", name(point.task)},
                    {"probe_rms_nm", point.probe_rms_nm},
                    {"batch_relative_rms_error", three(point.batch.rms)},
                    {"recursive_relative_rms_error", three(point.recursive.rms)},
                    {"batch_valid_share", three(point.batch.valid_share)},
                    {"recursive_valid_share", three(point.recursive.valid_share)}});
  }
  return json;
}

Json checks_json(const ExperimentResults& results) {
  Json json = Json::array();
  for (const FrequencyCheck& check : results.checks) {
    json.push_back(
        {{"task", name(check.row.task)},
         {"hands", name(check.row.hands)},
         {"printed_hz", check.row.natural_frequency_hz.nominal},
         {"damping_ratio", check.damping_ratio},
         {"equation_5_hz", number(check.equation_5_hz)},
         {"undamped_hz", check.undamped_hz},
         {"highest_hz_of_any_inertia", check.highest_hz},
         {"inertia_that_would_agree_kgm2", {number(check.smaller_inertia_kgm2), number(check.larger_inertia_kgm2)}}});
  }
  return json;
}

Json convergence_json(const ExperimentResults& results) {
  Json cases = Json::array();
  for (const ConvergenceCase& one : results.convergence) {
    Json traces = Json::array();
    for (const ConvergenceTrace& trace : one.traces) {
      traces.push_back({{"start", arm_json(trace.start)},
                        {"reached", trace.reached},
                        {"order", number(order_of(trace))},
                        {"distance", trace.distance},
                        {"cosine", trace.cosine}});
    }
    cases.push_back({{"record", one.name},
                     {"predicted_factor", one.predicted_factor},
                     {"measured_factor", one.measured_factor},
                     {"traces", traces}});
  }
  Json ranks = Json::array();
  for (const RankCase& one : results.ranks) {
    ranks.push_back({{"record", one.name}, {"rank", one.rank}, {"gamma", number(one.gamma)}, {"says", one.says}});
  }
  return {{"cases", cases},
          {"basin",
           {{"inertia_kgm2", results.basin.inertia_kgm2},
            {"stiffness_nm_per_rad", results.basin.stiffness_nm_per_rad},
            {"steps_of_unit_length", results.basin.unit_steps},
            {"steps_with_line_search", results.basin.line_search},
            {"reached_with_unit_length", results.basin.unit_share()},
            {"reached_with_line_search", results.basin.line_search_share()}}},
          {"rank", ranks}};
}

Json confusion_json(const Confusion& table) { return Json(table); }

Json driver_json(const DriverStateScore& score, double probe_rms_nm) {
  Json detections = Json::array();
  for (const Detection& one : score.detections) {
    detections.push_back({{"from", name(one.from)}, {"to", name(one.to)}, {"after_s", number(one.after_s)}});
  }
  return {{"probe_rms_nm", probe_rms_nm},
          {"drives", score.drives},
          {"columns", {"unknown", "hands_off", "relaxed", "braced"}},
          {"seconds", confusion_json(score.state)},
          {"seconds_settled", confusion_json(score.state_settled)},
          {"hand_columns", {"unknown", "none", "one", "two"}},
          {"hand_seconds", confusion_json(score.hands)},
          {"wrong_share_of_told", score.wrong_share(score.state)},
          {"wrong_share_of_told_settled", score.wrong_share(score.state_settled)},
          {"told_share", score.told_share(score.state)},
          {"overlapping_arms_seconds", score.overlapping_s},
          {"detections", detections}};
}

Json grasp_json(const ExperimentResults& results) {
  Json json = Json::array();
  for (const GraspCheck& one : results.grasps) {
    json.push_back({{"hands", name(one.hands)},
                    {"moment_rms_nm", one.moment_rms_nm},
                    {"largest_force_n", one.largest_force_n},
                    {"reconstruction_error_rms_nm", one.error_rms_nm},
                    {"error_without_the_angle_rms_nm", one.fixed_error_rms_nm}});
  }
  return json;
}

Json figure_7_json(const ExperimentResults& results) {
  const IdentifiedRecord& record = results.run.plain[ExperimentRun::index(TaskKind::kActive, HandPosition::kRight3, 0)];
  return {{"subject", 1},
          {"task", "active"},
          {"hands", "right_3"},
          {"amplitude_fit_percent", number(record.quality.amplitude_fit_percent)},
          {"frequency_hz", record.quality.curves.frequency_hz},
          {"measured_rad", record.quality.curves.measured_rad},
          {"model_rad", record.quality.curves.model_rad}};
}

Json overdamped_json(const ExperimentResults& results) {
  Json json = Json::array();
  for (const Overdamped& one : results.overdamped) {
    json.push_back({{"subject", one.subject + 1},
                    {"task", name(one.task)},
                    {"hands", name(one.hands)},
                    {"true_damping_ratio", one.damping_ratio_truth},
                    {"batch_damping_ratio", number(one.damping_ratio_found)}});
  }
  return json;
}

}  // namespace

std::string experiment_json(const ExperimentResults& results, const nlohmann::ordered_json& program) {
  const ExperimentSettings& settings = results.run.settings;
  Json all = results.run.plain.empty() ? Json::array() : records_json(results.run.plain);
  for (Json& record : records_json(results.run.probed)) all.push_back(record);
  const Json json = {
      {"schema", "steerid.experiment/1"},
      {"program", program},
      {"seed", settings.seed},
      {"subjects", kSubjects},
      {"probe_rms_nm", settings.probe_rms_nm},
      {"unmeasured_percent", settings.unmeasured_percent},
      {"stiffness_swing", settings.stiffness_swing},
      {"amplitude_fit_percent", results.plain_accuracy.pooled_percent},
      {"amplitude_fit",
       {{"as_in_the_paper", accuracy_json(results.plain_accuracy)},
        {"with_probe", accuracy_json(results.probed_accuracy)}}},
      {"amplitude_fit_over",
       {{"stiffness_swing", fit_points_json(results.fit.over_swing)},
        {"unmeasured_percent", fit_points_json(results.fit.over_unmeasured)}}},
      {"conclusions", conclusions(results)},
      {"put_in", put_in_json(results)},
      {"tables", tables_json(results)},
      {"overdamped", overdamped_json(results)},
      {"frequency_checks", checks_json(results)},
      {"figure_7", figure_7_json(results)},
      {"figure_8_and_9", all},
      {"figure_10", correlations_json(results)},
      {"excitation", excitation_json(results)},
      {"errors", errors_json(results)},
      {"probe_sweep", sweep_json(results)},
      {"grasp", grasp_json(results)},
      {"convergence", convergence_json(results)},
      {"driver_state",
       {driver_json(results.driver_probed, settings.probe_rms_nm), driver_json(results.driver_plain, 0)}}};
  return json.dump(1) + "\n";
}

}  // namespace steerid
