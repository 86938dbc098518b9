// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How a command is told what is in its logs: --columns, --sign, --with, --align, --dbc, the same for every command.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "log/log_format.hpp"
#include "log/record.hpp"
#include "log/record_quality.hpp"
#include "log/table_writer.hpp"

namespace steerid {

struct LogOptions {
  std::string columns;
  std::string sign;
  std::vector<std::filesystem::path> with{};  ///< further files of the drive, with clocks of their own
  std::vector<std::filesystem::path> dbc{};   ///< what the frames of a CAN log mean
  bool align = false;                         ///< by the lag that explains them best, beside their stamps

  /// Throws BadOption.
  [[nodiscard]] LogFormat format() const;
  /// The drive's files, `log` first.
  [[nodiscard]] std::vector<std::filesystem::path> files(const std::filesystem::path& log) const;
  /// Their record; `noticed` receives also by what lags they were aligned. Throws BadInput and BadOption.
  [[nodiscard]] Record read(const std::filesystem::path& log, RecordQuality* noticed = nullptr) const;
  [[nodiscard]] Record read(const std::vector<std::filesystem::path>& files, LogFormat format,
                            RecordQuality* noticed = nullptr) const;
};

/// Adds --mcap-messages, of a command that writes tables.
void add_mcap_messages(CLI::App& command, McapMessages& messages);

/// Adds --columns, --sign, --with, --align and --dbc.
void add_log_options(CLI::App& command, LogOptions& options);

}  // namespace steerid
