// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The files that one run of a command reads and writes. No input is ever overwritten, and no two outputs go to one
// file, whatever way their names take: "./x", a link, or another name of the same file.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>

namespace steerid {

class FilesOfRun {
 public:
  /// `by` is the option that names the file, for sentences. A file may be read twice, standard input may not: throws
  /// BadOption.
  void reads(const std::filesystem::path& file, const std::string& by);

  /// Throws BadOption when the file is read, or is written already.
  void writes(const std::filesystem::path& file, const std::string& by);

  /// Whether a file is written to standard output.
  [[nodiscard]] bool writes_standard_output() const { return writes_standard_output_; }

 private:
  /// The canonical path of a file, and its device and inode where it is there.
  using Key = std::string;

  std::map<Key, std::pair<std::string, std::filesystem::path>> read_;
  std::map<Key, std::pair<std::string, std::filesystem::path>> written_;
  bool writes_standard_output_ = false;
};

}  // namespace steerid
