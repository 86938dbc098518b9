// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/study_files.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "log/output_folder.hpp"

namespace steerid {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kParameters = {"inertia_kgm2", "damping_nms_per_rad", "stiffness_nm_per_rad"};

Json interval(const Interval& i) { return Json::array({i.low, i.high}); }

Json parameter_json(const ParameterScore& p) {
  Json json = {{"truth", p.truth},
               {"cramer_rao_sd", p.bound},
               {"bias_percent", p.bias_percent},
               {"bias_standard_error_percent", p.bias_error_percent},
               {"rmse", p.rmse},
               {"rmse_over_bound", p.ratio},
               {"rmse_over_bound_95", interval(p.ratio_95)}};
  json["coverage"] = p.coverage ? Json(*p.coverage) : Json(nullptr);
  if (p.coverage) json["coverage_95"] = interval(p.coverage_95);
  return json;
}

Json method_json(Method method, const MethodScore& s) {
  Json json = {{"method", name(method)}, {"answered", s.answered}, {"restarted", s.restarted}};
  json["nees"] = s.nees ? Json(*s.nees) : Json(nullptr);
  if (s.nees) json["nees_limits_95"] = interval(s.nees_95);
  for (std::size_t i = 0; i < 3; ++i) json[kParameters[i]] = parameter_json(s.parameters[i]);
  return json;
}

std::string cell(const std::optional<double>& value) { return value ? fmt::format("{}", *value) : ""; }

}  // namespace

std::string study_csv(const StudyResult& result) {
  std::string text =
      fmt::format("# study {}, {} drives a case, seed {}\n", result.plan.name, result.drives, result.seed);
  text +=
      "wheel,noise,method,parameter,truth,cramer_rao_sd,bias_percent,bias_standard_error_percent,rmse,"
      "rmse_over_bound,rmse_over_bound_low,rmse_over_bound_high,coverage,coverage_low,coverage_high,nees,nees_low,"
      "nees_high,drives,answered,restarted\n";
  for (const CaseResult& one : result.cases) {
    for (std::size_t m = 0; m < one.scores.size(); ++m) {
      const MethodScore& s = one.scores[m];
      for (std::size_t i = 0; i < 3; ++i) {
        const ParameterScore& p = s.parameters[i];
        const auto with = [](const std::optional<double>& owner, double value) {
          return owner ? std::optional(value) : std::nullopt;
        };
        text += fmt::format("{},{},\"{}\",{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", one.what.wheel,
                            one.what.noise, name(result.plan.methods[m]), kParameters[i], p.truth, p.bound,
                            p.bias_percent, p.bias_error_percent, p.rmse, p.ratio, p.ratio_95.low, p.ratio_95.high,
                            cell(p.coverage), cell(with(p.coverage, p.coverage_95.low)),
                            cell(with(p.coverage, p.coverage_95.high)), cell(s.nees), cell(with(s.nees, s.nees_95.low)),
                            cell(with(s.nees, s.nees_95.high)), s.drives, s.answered, s.restarted);
      }
    }
  }
  return text;
}

std::string study_json(const StudyResult& result, const nlohmann::ordered_json& made_by) {
  Json json = {{"schema", "steerid.study/1"},
               {"study", result.plan.name},
               {"drives", result.drives},
               {"seed", result.seed},
               {"cases", Json::array()}};
  for (const CaseResult& one : result.cases) {
    const SteadyDrive& drive = one.what.drive;
    Json methods = Json::array();
    for (std::size_t m = 0; m < one.scores.size(); ++m) {
      methods.push_back(method_json(result.plan.methods[m], one.scores[m]));
    }
    json["cases"].push_back({{"wheel", one.what.wheel},
                             {"noise", one.what.noise},
                             {"angle_noise_rad", drive.angle_noise_rad},
                             {"angle_step_rad", drive.angle_step_rad},
                             {"torque_noise_nm", drive.torque_noise_nm},
                             {"unmeasured_torque_nm", drive.unmeasured_torque_nm},
                             {"probe_rms_nm", drive.probe_rms_nm},
                             {"duration_s", static_cast<double>(drive.samples) / kStudyRate_hz},
                             {"methods", methods}});
  }
  json.update(made_by);
  return json.dump(2) + "\n";
}

void write_study(const std::filesystem::path& folder, const StudyResult& result,
                 const nlohmann::ordered_json& made_by) {
  const std::string csv = study_csv(result);
  const std::string json = study_json(result, made_by);
  const std::string html = report::html(study_page(result));
  const std::string& name = result.plan.name;
  write_together(folder, {{name + ".csv", csv}, {name + ".json", json}, {name + ".html", html}});
}

}  // namespace steerid
