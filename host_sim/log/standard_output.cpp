// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/standard_output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "log/bad_input.hpp"

namespace steerid {
namespace {

int kept = -1;  // what standard output was, once something else is in its place
bool nothing = false;

void print_to(int descriptor) {
  (void)std::fflush(stdout);
  if (kept < 0) kept = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  ::dup2(descriptor, STDOUT_FILENO);
}

}  // namespace

void keep_standard_output_for_a_file() {
  if (!nothing) print_to(STDERR_FILENO);
}

bool prints_nothing() { return nothing; }

void print_nothing() {
  nothing = true;
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  print_to(nowhere);
  ::close(nowhere);
}

int open_standard_output() {
  (void)std::fflush(stdout);
  return ::fcntl(kept >= 0 ? kept : STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
}

void finish_printing() {
  errno = 0;
  const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
  if (!failed) return;
  if (errno == EPIPE) throw ReaderGone();
  throw bad_input({.file = "standard output",
                   .expected = "room to write",
                   .found = errno != 0 ? fmt::format("\"{}\"", std::strerror(errno)) : "an error of an earlier write",
                   .advice = "send it elsewhere"});
}

}  // namespace steerid
