// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/blind_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "log/whole_file.hpp"
#include "study/several_score.hpp"

namespace steerid::blind_study {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json share_json(const Share& share) {
  const Interval ci = share.ci95();
  return {{"share", number(share.value())},
          {"ci95", Json::array({number(ci.low), number(ci.high)})},
          {"some", share.some},
          {"all", share.all}};
}

Json reliability_json(const std::vector<ReliabilityBand>& bands) {
  Json json = Json::array();
  for (const ReliabilityBand& band : bands) {
    json.push_back({{"probability", {band.low, band.high}},
                    {"mean_probability", number(band.mean_probability)},
                    {"right", share_json(band.right)}});
  }
  return json;
}

Json scores_json(const Scores& s) {
  Json json = {{"cases", s.cases},
               {"refused", s.refused},
               {"right", share_json(s.right)},
               {"right_or_equivalent", share_json(s.right_or_equivalent)},
               {"top1", share_json(s.top1)},
               {"top3", share_json(s.top3)},
               {"false_alarms", share_json(s.false_alarms)},
               {"unknown_called_unknown", share_json(s.abstained)},
               {"needlessly_unknown", share_json(s.needlessly_unknown)},
               {"mean_probability_on_truth", number(s.mean_probability)},
               {"brier", number(s.brier)},
               {"calibration_error", number(s.calibration_error)},
               {"median_closed_fraction", number(s.median_closed)},
               {"closed_fraction_interval_covers", share_json(s.closed_covers)}};
  for (const auto& [label, of] : s.labels) {
    json["labels"][label] = {{"cases", of.cases},
                             {"right", share_json(of.right)},
                             {"mean_probability", number(of.mean_probability)},
                             {"verdicts", of.verdicts}};
  }
  json["outside_vocabulary"] = s.outside;
  json["detection"] = Json::array();
  for (const GapBand& band : s.detection) {
    json["detection"].push_back({{"gap_over_floor", {band.low, band.high}},
                                 {"noticed", share_json(band.noticed)},
                                 {"right", share_json(band.right)}});
  }
  json["reliability"] = reliability_json(s.reliability);
  for (const auto& [name, of] : s.recovery) {
    json["recovery"][name] = {{"cases", of.cases},
                              {"median_error_percent", number(of.median_error_percent)},
                              {"p90_error_percent", number(of.p90_error_percent)},
                              {"interval_covers", share_json(of.covered)}};
  }
  return json;
}

Json pairs_json(const PairScores& s) {
  return {{"cases", s.cases},
          {"both_named", share_json(s.both_named)},
          {"one_named", share_json(s.one_named)},
          {"only_true", share_json(s.only_true)},
          {"median_closed_fraction", number(s.median_closed)}};
}

Json change_json(const ChangeScore& s) {
  return {
      {"exact", share_json(s.exact)}, {"all_named", share_json(s.all_named)}, {"only_true", share_json(s.only_true)}};
}

Json several_json(const SeveralScores& s) {
  Json json = {{"cases", s.cases},
               {"refused", s.refused},
               {"all", change_json(s.all)},
               {"brier", number(s.brier)},
               {"calibration_error", number(s.calibration_error)},
               {"median_closed_fraction", number(s.median_closed)}};
  for (const auto& [name, of] : s.of) json["cases_of"][name] = change_json(of);
  json["reliability"] = reliability_json(s.reliability);
  return json;
}

/// "add delay", "resize gravity_imbalance"; joined by semicolons.
std::string words(const std::set<Change>& changes) {
  std::vector<std::string> all;
  for (const auto& [effect, change] : changes) all.push_back(fmt::format("{} {}", change, effect));
  return fmt::format("{}", fmt::join(all, "; "));
}

Json leave_one_out_json(const LeaveOneOutScores& s) {
  Json json = {{"unknown_or_equivalent", share_json(s.unknown)}};
  for (const auto& [effect, of] : s.effects) {
    json["effects"][effect] = {{"unknown_or_equivalent", share_json(of.unknown)}, {"impostors", of.impostors}};
  }
  return json;
}

std::string in_percent(const Share& share) {
  if (share.all == 0) return "none of that kind";
  const Interval ci = share.ci95();
  return fmt::format("{:5.1f} %  ({:.1f} to {:.1f})  {} of {}", 100 * share.value(), 100 * ci.low, 100 * ci.high,
                     share.some, share.all);
}

}  // namespace

std::string blind_json(const Study& study, const nlohmann::ordered_json& made_by) {
  Json json = {{"schema", "steerid.blind_study/1"}, {"seed", study.seed}, {"key_sha256", study.key_sha256}};
  if (!study.cases.empty()) json["single"] = scores_json(score(study.cases));
  if (!study.pairs.empty()) json["pairs"] = pairs_json(score_pairs(study.pairs));
  if (!study.several.empty()) json["several"] = several_json(score_several(study.several));
  if (!study.left_out.empty()) {
    json["leave_one_out"] = leave_one_out_json(score_leave_one_out(study.left_out, study.left_out_whole));
  }
  json.update(made_by);
  return json.dump(1) + "\n";
}

std::string blind_csv(const Study& study) {
  std::string text =
      "part,case,label,effects,gap_over_floor,verdict,probability_of_label,equivalent,causes,closed_fraction\n";
  const auto add = [&](const char* part, const std::vector<Case>& cases) {
    for (const Case& one : cases) {
      const Answer answer = one.answer.value_or(Answer{.verdict = "refused"});
      std::vector<std::string> causes;
      for (const NamedCause& cause : answer.causes) causes.push_back(cause.effect);
      const auto p = answer.probability.find(one.truth.label);
      text += fmt::format("{},{},{},{},{:.4g},{},{:.4g},{},{},{}\n", part, one.name, one.truth.label,
                          fmt::join(one.truth.effects, " "), one.truth.gap_over_floor, answer.verdict,
                          p == answer.probability.end() ? 0.0 : p->second, fmt::join(answer.equivalent, " "),
                          fmt::join(causes, " "),
                          answer.closed_fraction ? fmt::format("{:.4g}", answer.closed_fraction->value) : "");
    }
  };
  add("single", study.cases);
  add("pair", study.pairs);
  add("leave_one_out", study.left_out);
  for (const Case& one : study.several) {
    const Answer answer = one.answer.value_or(Answer{.verdict = "refused"});
    const auto p = answer.probability.find(one.truth.label);
    text += fmt::format("{},{},{},{},{:.4g},{},{:.4g},{},{},{}\n", one.truth.several_case, one.name, one.truth.label,
                        words(one.truth.changes), one.truth.gap_over_floor, answer.verdict,
                        p == answer.probability.end() ? 0.0 : p->second, fmt::join(answer.equivalent, " "),
                        words(answer.changes()),
                        answer.closed_fraction ? fmt::format("{:.4g}", answer.closed_fraction->value) : "");
  }
  return text;
}

std::string blind_text(const Study& study) {
  std::string text;
  const auto line = [&](std::string_view name, const std::string& figure) {
    text += fmt::format("  {:34}{}\n", name, figure);
  };
  if (!study.cases.empty()) {
    const Scores s = score(study.cases);
    text += fmt::format("{} records, one effect or none, {} refused\n", s.cases, s.refused);
    line("verdict right", in_percent(s.right));
    line("right, or called equivalent", in_percent(s.right_or_equivalent));
    line("most probable", in_percent(s.top1));
    line("among the three most probable", in_percent(s.top3));
    line("effect named where there is none", in_percent(s.false_alarms));
    line("unknown effects called unknown", in_percent(s.abstained));
    line("needlessly unknown", in_percent(s.needlessly_unknown));
    line("mean probability on the truth", fmt::format("{:.3f}", s.mean_probability));
    line("Brier score", fmt::format("{:.3f}", s.brier));
    line("calibration error", fmt::format("{:.3f}", s.calibration_error));
    line("gap closed, median", fmt::format("{:.1f} %", 100 * s.median_closed));
    line("its interval covers", in_percent(s.closed_covers));
  }
  if (!study.pairs.empty()) {
    const PairScores s = score_pairs(study.pairs);
    text += fmt::format("{} records with two effects\n", s.cases);
    line("both named", in_percent(s.both_named));
    line("one named", in_percent(s.one_named));
    line("nothing named that is not there", in_percent(s.only_true));
  }
  if (!study.several.empty()) {
    const SeveralScores s = score_several(study.several);
    text += fmt::format("{} records whose simulations have to change in any way, {} refused\n", s.cases, s.refused);
    line("all changes named, and no other", in_percent(s.all.exact));
    for (const auto& [name, of] : s.of) line("  " + name, in_percent(of.exact));
    line("all changes named", in_percent(s.all.all_named));
    line("no change named that is not there", in_percent(s.all.only_true));
    line("calibration error", fmt::format("{:.3f}", s.calibration_error));
  }
  if (!study.left_out.empty()) {
    const LeaveOneOutScores s = score_leave_one_out(study.left_out, study.left_out_whole);
    text += fmt::format("{} records whose effect was taken out of the library\n", study.left_out.size());
    line("unknown, or an equivalent effect", in_percent(s.unknown));
  }
  return text;
}

void write_blind_study(const std::filesystem::path& folder, const Study& study, const nlohmann::ordered_json& made_by) {
  WholeFile json(folder / "blind.json");
  WholeFile csv(folder / "blind.csv");
  WholeFile page(folder / "blind.html");
  json.write(blind_json(study, made_by));
  csv.write(blind_csv(study));
  page.write(report::html(blind_page(study)));
  json.commit();
  csv.commit();
  page.commit();
}

}  // namespace steerid::blind_study
