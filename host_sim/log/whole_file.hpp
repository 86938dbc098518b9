// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// An output file that appears whole or not at all: written beside its target under a hidden name
// (.NAME.partial-PID-N), brought to the disk, then renamed over the target in one step.
//
// A reader sees the old file or the new one, never a part. Without commit(), by an exception or a signal too
// (log/unfinished_files.hpp), the target keeps what it had and the partial file goes; only SIGKILL leaves one behind. A
// symbolic link is followed, an existing file keeps its permissions, a device or a pipe that somebody reads is written
// directly. "-" is standard output (log/standard_output.hpp); a file of that name is written as "./-".
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace steerid {

class WholeFile {
 public:
  /// Opens the partial file. Throws BadInput when the folder does not exist or cannot be written, or the target is a
  /// folder or a pipe that nobody reads.
  explicit WholeFile(const std::filesystem::path& target);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// Appends. Throws BadInput when the disk is full or fails.
  void write(std::string_view text);

  /// Puts the file in its place; write() no more after it. Throws BadInput as write() does.
  void commit();

 private:
  void flush();
  [[noreturn]] void complain(std::string_view what, int error) const;

  std::filesystem::path target_;
  std::filesystem::path partial_;  // empty when the target is written directly
  std::string buffer_;
  int descriptor_ = -1;
};

/// A file of one piece.
void write_whole_file(const std::filesystem::path& target, std::string_view text);

}  // namespace steerid
