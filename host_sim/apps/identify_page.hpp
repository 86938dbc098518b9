// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The page of `steerid identify --report`: both answers, the trace and the free run, given to the report's parts.
#pragma once

#include <optional>
#include <string>

#include "apps/answers.hpp"
#include "apps/credibility.hpp"
#include "apps/driver_timeline.hpp"
#include "apps/own_arm.hpp"
#include "fit/varying_arm.hpp"
#include "log/record.hpp"
#include "report/identify_report.hpp"

namespace steerid {

struct IdentifyPageInput {
  std::string record_name;
  std::string subtitle;  ///< one sentence about the record
  const Record& record;
  const FirmwareRun& run;
  const DriverTimeline& driver;
  const Answer& recursive;
  const std::optional<Answer>& batch;
  const std::optional<VaryingArm>& over_time;
  const std::optional<OwnArm>& own_arm;
  const Credibility& credibility;
  std::vector<std::string> notes;  ///< sentences about the record
};

report::Page identify_page(const IdentifyPageInput& input);

}  // namespace steerid
