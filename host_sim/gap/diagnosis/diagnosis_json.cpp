// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/diagnosis_json.hpp"

#include <cmath>

namespace steerid::gap {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinity and no NaN.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json ci95(const BoundedValue& interval) { return Json::array({number(interval.low), number(interval.high)}); }

Json with_interval(const BoundedValue& interval) {
  return {{"value", number(interval.value)}, {"ci95", ci95(interval)}};
}

Json cause_json(const Cause& cause) {
  Json values = Json::object();
  Json intervals = Json::object();
  for (std::size_t i = 0; i < cause.effect.values.size(); ++i) {
    const std::string name(cause.effect.type->parameters[i].name);
    values[name] = number(cause.effect.values[i]);
    if (i < cause.parameters.size()) intervals[name] = ci95(cause.parameters[i]);
  }
  Json out = {{"effect", cause.effect.type->id},          {"change", name(cause.change)},
              {"probability", number(cause.probability)}, {"parameters", values},
              {"closes", number(cause.closes)},           {"ci95", intervals}};
  if (cause.was) {
    Json was = Json::object();
    for (std::size_t i = 0; i < cause.was->values.size(); ++i) {
      was[std::string(cause.was->type->parameters[i].name)] = number(cause.was->values[i]);
    }
    out["was"] = was;
  }
  return out;
}

Json included_json(const ChangeInclusion& one) {
  Json out = {{"effect", one.type->id}, {"change", name(one.kind)}, {"probability", number(one.probability)}};
  out["from"] = {{"among_sets", number(one.features.among_sets)},
                 {"gain_nats", number(one.features.gain_nats)},
                 {"left_nats", number(one.features.left_nats)},
                 {"gap_nats", number(one.features.gap_nats)},
                 {"discrepancy_nats", number(one.features.discrepancy_nats)},
                 {"shift", number(one.features.shift)}};
  return out;
}

Json where_json(const GapPlace& where) {
  return {{"axis", where.axis},
          {"range", Json::array({number(where.low), number(where.high)})},
          {"unit", where.unit},
          {"share_of_gap", number(where.share_of_gap.value)},
          {"share_of_gap_ci95", ci95(where.share_of_gap)},
          {"says", where.says}};
}

Json axis_json(const GapAxis& axis) {
  Json bins = Json::array();
  for (std::size_t i = 0; i < axis.bins.size(); ++i) {
    const GapBin& bin = axis.bins[i];
    Json entry = {{"range", Json::array({number(bin.low), number(bin.high)})},
                  {"share_of_gap", number(bin.share.value)},
                  {"ci95", ci95(bin.share)},
                  {"expected_share", number(bin.expected_share)}};
    if (i < axis.bin_names.size()) entry["name"] = axis.bin_names[i];
    bins.push_back(entry);
  }
  return {{"axis", axis.axis}, {"unit", axis.unit}, {"concentration", number(axis.concentration)}, {"bins", bins}};
}

Json gap_json(const GapSizes& gap) {
  return {{"sim_nrmse", number(gap.sim_nrmse)},
          {"refit_nrmse", number(gap.refit_nrmse)},
          {"with_effect_nrmse", number(gap.with_effect_nrmse)},
          {"floor_nrmse", number(gap.floor_nrmse)},
          {"closed_fraction", number(gap.closed_fraction.value)},
          {"closed_fraction_ci95", ci95(gap.closed_fraction)},
          {"torque",
           {{"refit", number(gap.torque_refit)},
            {"with_effect", number(gap.torque_with_effect)},
            {"floor", number(gap.torque_floor)}}}};
}

Json next_json(const NextExperiment& next) {
  const ProbeProposal& probe = next.probe;
  return {{"why", next.why},
          {"probe",
           {{"rms_nm", probe.rms_nm},
            {"low_hz", probe.low_hz},
            {"high_hz", probe.high_hz},
            {"period_s", probe.period_s},
            {"duration_s", probe.duration_s}}},
          {"separates", next.separates[0].empty() ? Json::array() : Json(next.separates)},
          {"separation_nats", number(next.separation)}};
}

Json band_json(const std::optional<Unexplained::Band>& band) {
  if (!band) return nullptr;
  return {{"axis", "frequency"},
          {"range", Json::array({band->low_hz, band->high_hz})},
          {"unit", "Hz"},
          {"share", number(band->share)}};
}

Json evidence_json(const SetEvidence& evidence) {
  Json changes = Json::array();
  for (const SetEvidence::Change& one : evidence.changes) {
    changes.push_back({{"effect", one.effect}, {"change", name(one.change)}});
  }
  return {{"changes", changes},
          {"wheel", evidence.wheel_given ? "given" : "free"},
          {"nats", number(evidence.nats)},
          {"excess", number(evidence.excess)},
          {"lines", number(evidence.lines)},
          {"left_nats", number(evidence.left_nats)},
          {"occam", number(evidence.occam)},
          {"log_odds", number(evidence.log_odds)}};
}

}  // namespace

Json diagnosis_json(const Diagnosis& diagnosis) {
  Json ranking = Json::array();
  for (const RankedEffect& one : diagnosis.ranking) {
    ranking.push_back({{"effect", one.id}, {"probability", one.probability}});
  }
  Json causes = Json::array();
  for (const Cause& cause : diagnosis.causes) causes.push_back(cause_json(cause));
  Json inclusion = Json::array();
  for (const ChangeInclusion& one : diagnosis.inclusion) inclusion.push_back(included_json(one));
  Json evidence = Json::array();
  for (const SetEvidence& one : diagnosis.evidence) evidence.push_back(evidence_json(one));
  Json axes = Json::array();
  for (const GapAxis& axis : diagnosis.axes) axes.push_back(axis_json(axis));
  return {{"schema", "steerid.diagnosis/1"},
          {"verdict", diagnosis.verdict},
          {"probability", number(probability_of_answer(diagnosis))},
          {"ranking", ranking},
          {"evidence", evidence},
          {"causes", causes},
          {"unexplained",
           {{"share_of_gap", number(diagnosis.unexplained.share_of_gap)},
            {"where", band_json(diagnosis.unexplained.where)},
            {"complete", diagnosis.unexplained.complete}}},
          {"inclusion", inclusion},
          {"surrogate", diagnosis.surrogate},
          {"equivalent", diagnosis.equivalent},
          {"where", where_json(diagnosis.where)},
          {"axes", axes},
          {"gap", gap_json(diagnosis.gap)},
          {"base",
           {{"inertia_kgm2", with_interval(diagnosis.base.inertia_kgm2)},
            {"damping_nms_per_rad", with_interval(diagnosis.base.damping_nms_per_rad)},
            {"stiffness_nm_per_rad", with_interval(diagnosis.base.stiffness_nm_per_rad)}}},
          {"next_experiment", next_json(diagnosis.next_experiment)},
          {"notes", diagnosis.notes}};
}

nlohmann::ordered_json together_json(const Together& together, std::span<const NamedRecord> records) {
  Json all = {{"records", Json::array()}, {"together", Json::array()}};
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Json answer = diagnosis_json(together.records[i]);
    Json own = {{"record", records[i].name}};
    for (const char* key : {"causes", "unexplained", "gap", "base", "notes"}) own[key] = answer[key];
    all["records"].push_back(std::move(own));
  }
  for (const SharedNumber& shared : together.numbers) {
    Json values = Json::array();
    for (const BoundedValue& one : shared.values) values.push_back(with_interval(one));
    all["together"].push_back({{"of", shared.of},
                               {"parameter", shared.parameter},
                               {"value", number(shared.together.value)},
                               {"ci95", ci95(shared.together)},
                               {"differs", shared.differs},
                               {"values", values}});
  }
  return all;
}

}  // namespace steerid::gap
