// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How far work is that takes more than a moment, on standard error.
//
//   reading drive.csv [##########..............................]  25 %, 40 s left     on a terminal
//   reading drive.csv: 25 %, 3 min left                                               in a pipe, a line a minute
//
// The bar is drawn when the whole percentage changes, at most 101 times, and wipes its line when it goes out of scope.
// What is left is told from the second second on, as if the rest went as fast as what is done.
#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>

namespace steerid {

class Progress {
 public:
  /// `total` in any unit; 0 shows nothing.
  /// `now_s` is the clock.
  Progress(std::string label, std::uint64_t total, std::FILE* out = stderr, std::function<double()> now_s = steady_s);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Seconds on a clock that never goes back.
  static double steady_s();

  /// `done` of `total`; cheap enough for an inner loop.
  void at(std::uint64_t done) {
    if (done >= next_) draw(done);
  }

 private:
  void draw(std::uint64_t done);

  std::string label_;
  std::uint64_t total_;
  std::FILE* out_;
  std::function<double()> now_s_;
  double began_s_;
  double told_s_;  // when the last line went into a pipe
  bool terminal_;
  std::uint64_t next_;  // where the percentage changes next; the largest number when nothing is shown
  bool drawn_ = false;
};

}  // namespace steerid
