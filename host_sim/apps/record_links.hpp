// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Where the page of a fleet leads to.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace steerid {

class RecordLinks {
 public:
  /// `answers` is the folder of the answers; the page lies in a folder of it.
  explicit RecordLinks(std::filesystem::path answers) : answers_(std::move(answers)) {}

  /// "../NAME/report.html" with what a URL cannot hold escaped; the record's answer where it has no page.
  [[nodiscard]] std::string to(std::string_view record) const;

 private:
  std::filesystem::path answers_;
};

}  // namespace steerid
