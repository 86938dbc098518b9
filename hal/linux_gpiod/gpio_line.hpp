// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One GPIO line, requested from the kernel through libgpiod and released when the object goes, on every way out.
//
// A line is named by its chip and offset ("gpiochip0", 4), or by its name alone, which is then looked for on every chip
// (device tree: gpio-line-names). Levels are logical: an active-low line that is active is electrically low.
//
// The same header stands before libgpiod 1.x (gpio_line_v1.cpp) and 2.x (gpio_line_v2.cpp); the build takes the one
// that is installed. Constructors throw Failure with a sentence for: no such chip, no such line, line in use (by whom),
// no permission, a bias that the chip cannot do. The other calls neither throw nor allocate.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/status.hpp"

namespace steerid::linux_gpiod {

enum class Bias : std::uint8_t { kAsIs, kDisabled, kPullUp, kPullDown };

struct LineConfig {
  std::string chip;  ///< "gpiochip0", "/dev/gpiochip0" or a chip's label; empty: any chip that has a line of this name
  std::string name;  ///< empty: by offset
  unsigned offset = 0;
  bool active_low = false;
  Bias bias = Bias::kAsIs;
};

/// "line 4 of gpiochip0" or "line SAMPLE_READY", for messages.
std::string describe(const LineConfig& line);

/// What is shown as the line's user by gpioinfo.
inline constexpr const char* kConsumer = "steerid-ecu";

/// A requested line, whichever libgpiod holds it; defined in the file of that version.
struct LineRequest;
struct LineRelease {
  void operator()(LineRequest* request) const;
};
using LineHandle = std::unique_ptr<LineRequest, LineRelease>;

class OutputLine {
 public:
  /// Drives `level` from the moment of the request on.
  OutputLine(const LineConfig& line, bool level);
  /// kOk or kIoError (the chip is gone).
  Status set(bool level);

 private:
  LineHandle request_;
};

class InputLine {
 public:
  explicit InputLine(const LineConfig& line);
  /// kOk, or kIoError with `level` unchanged.
  Status read(bool& level);

 private:
  LineHandle request_;
};

/// Changes from inactive to active, each with the kernel's own stamp (CLOCK_MONOTONIC, taken in the interrupt).
class EdgeLine {
 public:
  explicit EdgeLine(const LineConfig& line);
  /// Readable while an edge is queued; the kernel keeps the oldest 16 and drops what does not fit.
  [[nodiscard]] int descriptor() const;
  /// The oldest queued edge. kOk, kNoData, or kIoError (the chip is gone).
  Status read(std::int64_t& stamp_ns);

 private:
  LineHandle request_;
};

}  // namespace steerid::linux_gpiod
