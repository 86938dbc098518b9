// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "linux_ecu/journal.hpp"

#include <unistd.h>

#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

namespace steerid::linux_ecu {

void log(Level level, const char* format, ...) {
  static const bool to_journal = std::getenv("JOURNAL_STREAM") != nullptr;
  std::array<char, kLongest> line{};
  int length = to_journal ? std::snprintf(line.data(), line.size(), "<%c>", static_cast<char>(level)) : 0;
  const auto room = [&] { return line.size() - 1 - static_cast<std::size_t>(length); };
  std::va_list arguments;
  va_start(arguments, format);
  const int text = std::vsnprintf(line.data() + length, room(), format, arguments);
  va_end(arguments);
  length += text < 0 ? 0 : text < static_cast<int>(room()) ? text : static_cast<int>(room()) - 1;
  line[static_cast<std::size_t>(length++)] = '\n';
  // One write a line, so that lines of two processes do not mix. A log that cannot be written is no reason to stop.
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line.data(), static_cast<std::size_t>(length));
}

}  // namespace steerid::linux_ecu
