// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The reader of MCAP and of ROS 2's messages must end every text in columns that keep their promises, or in one
// BadInput of one line.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>

#include "log/bad_input.hpp"
#include "log/mcap_source.hpp"
#include "log/message_numbers.hpp"
#include "promise.hpp"

namespace {

using steerid::fuzz::check_sentence;
using steerid::fuzz::promise;

void read_file(const std::string& bytes) {
  const auto source =
      steerid::open_mcap({.in = std::make_unique<std::istringstream>(bytes), .name = "fuzz.mcap", .dbc = {}});
  steerid::Wanted wanted;
  for (std::size_t i = 0; i < source->columns().size(); ++i) wanted.columns.push_back({.column = i, .to_si = {}});
  for (const steerid::StampedColumns& group : source->read(wanted)) {
    promise(std::ranges::is_sorted(group.time_s), "stamps that never go back");
    for (const double time_s : group.time_s) promise(std::isfinite(time_s), "finite stamps");
    for (const auto& column : group.values) {
      promise(column.size() == group.time_s.size(), "a value for each stamp");
      for (const double value : column) promise(!std::isinf(value), "finite values, or none");
    }
  }
}

/// A definition and a message behind the first zero byte.
void read_message(std::string_view bytes) {
  const std::size_t end = std::min(bytes.find('\0'), bytes.size());
  const auto numbers = steerid::ros2_numbers("a/B", bytes.substr(0, end));
  if (numbers) (void)numbers->read(bytes.substr(end), [](std::string_view, double) {});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  read_message(bytes);
  try {
    read_file(bytes);
  } catch (const steerid::BadInput& error) {
    check_sentence(error.what(), 65536);
  }
  return 0;
}
