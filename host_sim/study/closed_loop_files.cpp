// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The files of the closed-loop study.
#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "log/output_folder.hpp"
#include "report/page.hpp"
#include "study/closed_loop.hpp"

namespace steerid {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kParameters[] = {"inertia", "damping", "stiffness"};

std::string label(const ClosedLoopCase& what) {
  return fmt::format("{}, probe {} Nm, unmeasured {} Nm", what.name, what.probe_rms_nm, what.unmeasured_nm);
}

std::string csv(const ClosedLoopStudy& study) {
  std::string text = fmt::format("# study closed_loop, {} drives a case, seed {}\n", study.drives, study.seed);
  text +=
      "driver,gain_nm_per_rad,unmeasured_nm,probe_rms_nm,parameter,valid_share,recursive_bias_percent,"
      "recursive_standard_error_percent,probe_instrument_bias_percent,probe_instrument_standard_error_percent\n";
  for (const ClosedLoopResult& one : study.results) {
    for (int i = 0; i < 3; ++i) {
      const std::string probe =
          one.what.probe_rms_nm > 0 ? fmt::format("{},{}", one.probe.percent(i), one.probe.error_percent(i)) : ",";
      text += fmt::format("{},{},{},{},{},{},{},{},{}\n", one.what.name, one.what.gain, one.what.unmeasured_nm,
                          one.what.probe_rms_nm, kParameters[i], one.valid_share(i), one.recursive.percent(i),
                          one.recursive.error_percent(i), probe);
    }
  }
  return text;
}

Json bias_json(const ClosedLoopBias& bias, int i) {
  return {{"bias_percent", bias.percent(i)}, {"standard_error_percent", bias.error_percent(i)}};
}

std::string json(const ClosedLoopStudy& study, const Json& made_by) {
  Json all = {{"schema", "steerid.study/1"},
              {"study", "closed_loop"},
              {"drives", study.drives},
              {"seed", study.seed},
              {"cases", Json::array()}};
  for (const ClosedLoopResult& one : study.results) {
    Json entry = {{"driver", one.what.name},
                  {"gain_nm_per_rad", one.what.gain},
                  {"unmeasured_nm", one.what.unmeasured_nm},
                  {"probe_rms_nm", one.what.probe_rms_nm}};
    for (int i = 0; i < 3; ++i) {
      entry[kParameters[i]] = {
          {"valid_share", one.valid_share(i)},
          {"recursive", bias_json(one.recursive, i)},
          {"probe_instrument", one.what.probe_rms_nm > 0 ? bias_json(one.probe, i) : Json(nullptr)}};
    }
    all["cases"].push_back(entry);
  }
  all.update(made_by);
  return all.dump(2) + "\n";
}

report::Bars chart(const ClosedLoopStudy& study, int parameter) {
  report::Bars bars;
  bars.title = fmt::format("{}: bias under a probe", kParameters[parameter]);
  bars.value = {.label = "bias", .unit = "%"};
  report::BarSeries recursive{.name = "recursive", .meaning = report::Meaning::kModel};
  report::BarSeries probe{.name = "probe as instrument", .meaning = report::Meaning::kReference};
  const auto add = [parameter](report::BarSeries& series, const ClosedLoopBias& bias) {
    series.values.push_back(bias.percent(parameter));
    series.low.push_back(bias.percent(parameter) - 1.96 * bias.error_percent(parameter));
    series.high.push_back(bias.percent(parameter) + 1.96 * bias.error_percent(parameter));
  };
  for (const ClosedLoopResult& one : study.results) {
    if (!(one.what.probe_rms_nm > 0)) continue;
    bars.categories.push_back(label(one.what));
    add(recursive, one.recursive);
    add(probe, one.probe);
  }
  bars.series = {recursive, probe};
  return bars;
}

report::Table table(const ClosedLoopStudy& study) {
  report::Table table;
  table.title = "All cases";
  table.columns = {{.label = "case", .numeric = false}};
  for (const char* symbol : {"J", "B", "C"}) {
    table.columns.push_back({.label = fmt::format("{} valid", symbol), .unit = "%", .digits = 3});
    table.columns.push_back({.label = fmt::format("{} recursive", symbol), .unit = "%", .digits = 2});
    table.columns.push_back({.label = fmt::format("{} by the probe", symbol), .unit = "%", .digits = 2});
  }
  for (const ClosedLoopResult& one : study.results) {
    std::vector<report::Cell> row = {label(one.what)};
    for (int i = 0; i < 3; ++i) {
      const double nothing = std::numeric_limits<double>::quiet_NaN();
      row.insert(row.end(), {100 * one.valid_share(i), one.recursive.percent(i),
                             one.what.probe_rms_nm > 0 ? one.probe.percent(i) : nothing});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

report::Page page(const ClosedLoopStudy& study) {
  report::Page page;
  page.title = "Study: closed_loop";
  page.subtitle = "What a driver's feedback does to the estimate";
  report::Headline head;
  head.verdict = fmt::format(
      "Bias of J, B and C when the driver answers to the angle after 150 ms: {} drives of 60 s in "
      "each of {} cases, seed {}.",
      study.drives, study.results.size(), study.seed);
  page.parts.push_back(head);
  for (int i = 0; i < 3; ++i) page.parts.push_back(chart(study, i));
  page.parts.push_back(table(study));
  page.footer = fmt::format("steerid study closed_loop --drives {} --seed {}", study.drives, study.seed);
  return page;
}

}  // namespace

void write_closed_loop(const std::filesystem::path& folder, const ClosedLoopStudy& study,
                       const nlohmann::ordered_json& made_by) {
  write_together(folder, {{"closed_loop.csv", csv(study)},
                          {"closed_loop.json", json(study, made_by)},
                          {"closed_loop.html", report::html(page(study))}});
}

}  // namespace steerid
