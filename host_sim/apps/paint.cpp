// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/paint.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

namespace steerid {
namespace {

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nobody sets it
  return value != nullptr && *value != '\0';
}

}  // namespace

bool paints() {
  const char* terminal = std::getenv("TERM");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  return !is_set("NO_COLOR") && terminal != nullptr && std::string_view(terminal) != "dumb" &&
         ::isatty(STDOUT_FILENO) == 1;
}

std::string painted(Paint paint, std::string_view text) {
  if (!paints()) return std::string(text);
  const int colour = paint == Paint::kRed ? 31 : (paint == Paint::kAmber ? 33 : 32);
  return fmt::format("\x1b[{}m{}\x1b[0m", colour, text);
}

}  // namespace steerid
