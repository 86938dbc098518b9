// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One record as `steerid identify` reads and answers it, alone or in a folder of them.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "apps/answers.hpp"
#include "apps/credibility.hpp"
#include "apps/driver_timeline.hpp"
#include "apps/firmware_run.hpp"
#include "apps/first_look.hpp"
#include "apps/log_options.hpp"
#include "apps/own_arm.hpp"
#include "fit/varying_arm.hpp"
#include "log/log_format.hpp"
#include "log/record.hpp"
#include "log/record_quality.hpp"
#include "log/resample.hpp"
#include "report/page.hpp"

namespace steerid {

/// What is asked of every record, in the words of the options.
struct IdentifyRequest {
  LogOptions log;
  std::string scalar = "float";
  bool batch = false;
  std::string torque_offset = "auto";
  std::filesystem::path wheel;  ///< of --wheel; empty: none

  [[nodiscard]] nlohmann::ordered_json json() const;
};

/// Dry friction of the wheel above the torsion bar, and by what it is known, as it is said.
struct WheelFrictionFound {
  double torque_nm = 0;
  std::string from;
};

/// A record and both answers to it.
struct IdentifiedLog {
  RecordQuality seen;
  Resampled resampled;  ///< the record itself, at 100 Hz
  FirstLook look;
  FirmwareRun run;
  Answer recursive;
  DriverTimeline driver;
  std::optional<Answer> batch;
  std::optional<VaryingArm> over_time;  ///< beside the batch answer
  std::optional<WheelAlone> wheel;      ///< of --wheel, or of rim and bar
  std::optional<WheelFrictionFound> friction;
  std::vector<std::string> clock_notes{};  ///< of an angle that is read by the torques' clock
  std::vector<std::string> batch_notes;    ///< sentences on the record as the batch fit sees it
  std::string what;                        ///< one sentence on how long the record is and what was done to it

  Credibility credibility;
  std::filesystem::path log;  ///< as the caller named it
  IdentifyRequest request;

  /// Every sentence about the record, each once.
  [[nodiscard]] std::vector<std::string> notes() const;
  /// Nothing without a wheel to take off `found`.
  [[nodiscard]] std::optional<OwnArm> own_arm_of(const Identification& found) const;
  [[nodiscard]] nlohmann::ordered_json json() const;
};

/// The log as it was read, before anything is computed.
struct ReadLog {
  Record record;
  RecordQuality seen;
  std::filesystem::path log;
};

/// Throws BadInput.
[[nodiscard]] ReadLog read_log(const std::filesystem::path& log, const IdentifyRequest& request);
[[nodiscard]] IdentifiedLog identify_log(const ReadLog& log, const IdentifyRequest& request);

/// The page of --report.
[[nodiscard]] report::Page identify_page_of(const std::string& record_name, const IdentifiedLog& found);
void write_identify_page(const std::filesystem::path& target, const std::string& record_name,
                         const IdentifiedLog& found);

}  // namespace steerid
