// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/study_findings.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>

#include "apps/made_from.hpp"
#include "log/bad_input.hpp"
#include "log/output_folder.hpp"
#include "log/progress.hpp"
#include "study/column_study.hpp"
#include "study/excitation.hpp"
#include "study/fault_campaign.hpp"
#include "study/findings.hpp"
#include "study/friction_study.hpp"
#include "study/hands.hpp"
#include "study/probe_study.hpp"
#include "study/soak.hpp"
#include "study/tracking.hpp"
#include "study/validity.hpp"

namespace steerid {
namespace {

struct Kind {
  const char* name;
  // The sizes that it has.
  bool drives = false;
  bool hours = false;
  bool changes = false;
  bool minutes = false;
  bool updates = false;
  bool unmeasured = false;
  bool angle_offset = false;
  std::function<Findings(const FindingsOptions&, const StudyProgress&)> run;
};

/// A size as the command line may give it, and the study's own.
template <class Study, class Given, class Own>
struct Size {
  std::optional<Given> FindingsOptions::*given;
  Own Study::*own;
};

template <class Study, class... Sizes>
auto sized(Findings (*run)(const Study&, const StudyProgress&), Sizes... sizes) {
  return [=](const FindingsOptions& options, const StudyProgress& at) {
    Study study{.seed = options.seed};
    ((study.*sizes.own = (options.*sizes.given).value_or(study.*sizes.own)), ...);
    return run(study, at);
  };
}

/// Of a study that has a number of drives, and more sizes.
template <class Study, class... Sizes>
auto by_drives(Findings (*run)(const Study&, const StudyProgress&), Sizes... more) {
  return sized(run, Size{&FindingsOptions::drives, &Study::drives}, more...);
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> kAll = {
      {.name = "column", .drives = true, .run = by_drives(run_column_study)},
      {.name = "probe", .drives = true, .run = by_drives(run_probe_study)},
      {.name = "excitation", .drives = true, .run = by_drives(run_excitation_study)},
      {.name = "tracking",
       .drives = true,
       .hours = true,
       .changes = true,
       .angle_offset = true,
       .run = by_drives(run_tracking_study, Size{&FindingsOptions::hours, &TrackingStudy::hours},
                        Size{&FindingsOptions::changes, &TrackingStudy::changes},
                        Size{&FindingsOptions::angle_offset_rad, &TrackingStudy::angle_offset_rad})},
      {.name = "hands",
       .drives = true,
       .hours = true,
       .run = by_drives(run_hands_study, Size{&FindingsOptions::hours, &HandsStudy::hours})},
      {.name = "friction", .drives = true, .run = by_drives(run_friction_study)},
      {.name = "validity",
       .drives = true,
       .minutes = true,
       .run = by_drives(run_validity_study, Size{&FindingsOptions::minutes, &ValidityStudy::minutes})},
      {.name = "faults",
       .drives = true,
       .unmeasured = true,
       .run = by_drives(run_fault_study, Size{&FindingsOptions::unmeasured_percent, &FaultStudy::unmeasured_percent})},
      {.name = "soak",
       .updates = true,
       .run = sized(run_soak_study, Size{&FindingsOptions::updates, &SoakStudy::updates})},
  };
  return kAll;
}

void refuse_foreign_sizes(const Kind& kind, const FindingsOptions& options) {
  const auto refuse = [&](bool given, bool known, const char* option) {
    if (given && !known) throw CLI::ValidationError(option, fmt::format("the study {} has no such size", kind.name));
  };
  refuse(options.drives.has_value(), kind.drives, "--drives");
  refuse(options.hours.has_value(), kind.hours, "--hours");
  refuse(options.changes.has_value(), kind.changes, "--changes");
  refuse(options.minutes.has_value(), kind.minutes, "--minutes");
  refuse(options.updates.has_value(), kind.updates, "--updates");
  refuse(options.unmeasured_percent.has_value(), kind.unmeasured, "--unmeasured");
  refuse(options.angle_offset_rad.has_value(), kind.angle_offset, "--angle-offset");
}

/// Sizes that were not given are the study's own; its command states them.
nlohmann::ordered_json made_by(const FindingsOptions& options) {
  nlohmann::ordered_json given = nlohmann::ordered_json::object();
  const auto add = [&](const char* name, const auto& size) {
    if (size) given[name] = *size;
  };
  add("drives", options.drives);
  add("hours", options.hours);
  add("changes", options.changes);
  add("minutes", options.minutes);
  add("updates", options.updates);
  add("unmeasured_percent", options.unmeasured_percent);
  add("angle_offset_rad", options.angle_offset_rad);
  given["seed"] = options.seed;
  return {{"options", given}, {"program", program_json()}};
}

}  // namespace

std::vector<std::string> findings_studies() {
  std::vector<std::string> names;
  for (const Kind& kind : kinds()) names.emplace_back(kind.name);
  return names;
}

void findings_study(const FindingsOptions& options) {
  for (const Kind& kind : kinds()) {
    if (kind.name != options.name) continue;
    refuse_foreign_sizes(kind, options);
    make_output_folder(options.out);
    Findings findings;
    {
      std::optional<Progress> progress;
      findings = kind.run(options, [&](std::size_t done, std::size_t of) {
        if (!progress) progress.emplace(kind.name, of);
        progress->at(done);
      });
    }
    fmt::print("{}\n", findings_text(findings));
    write_findings(options.out, findings, made_by(options));
    fmt::print("written to {}: {name}.csv, {name}.json, {name}.html\n", printable(options.out.string()),
               fmt::arg("name", kind.name));
  }
}

}  // namespace steerid
