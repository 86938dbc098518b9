// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A progress bar on standard error for work that takes more than a moment: drawn on a terminal, silent in a pipe.
//
//   reading drive.csv [##########..............................]  25 %
//
// It draws when the whole percentage changes, at most 101 times, and wipes its line when it goes out of scope.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

namespace steerid {

class Progress {
 public:
  /// `total` in any unit; 0 shows nothing.
  Progress(std::string label, std::uint64_t total, std::FILE* out = stderr);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` of `total`; cheap enough for an inner loop.
  void at(std::uint64_t done) {
    if (done >= next_) draw(done);
  }

 private:
  void draw(std::uint64_t done);

  std::string label_;
  std::uint64_t total_;
  std::FILE* out_;
  std::uint64_t next_;  // where the percentage changes next; the largest number when nothing is shown
  bool drawn_ = false;
};

}  // namespace steerid
