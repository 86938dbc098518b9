// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The studies that end in findings (study/findings.hpp): each asks for figures and says which of them are met.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace steerid {

/// Sizes that the command line leaves out are the study's own.
struct FindingsOptions {
  std::string name;
  std::filesystem::path out;
  std::optional<std::size_t> drives;
  std::optional<std::size_t> hours;
  std::optional<std::size_t> changes;
  std::optional<std::size_t> minutes;
  std::optional<std::uint64_t> updates;
  std::optional<double> unmeasured_percent;
  std::optional<double> angle_offset_rad;
  std::uint64_t seed = 1;
};

[[nodiscard]] std::vector<std::string> findings_studies();

/// Runs it, writes its files and prints what it found. Throws CLI::ValidationError for a size that the study has not.
void findings_study(const FindingsOptions& options);

}  // namespace steerid
