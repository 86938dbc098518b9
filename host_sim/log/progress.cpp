// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace steerid {

Progress::Progress(std::string label, std::uint64_t total, std::FILE* out)
    : label_(std::move(label)),
      total_(total),
      out_(out),
      next_(total > 0 && isatty(fileno(out)) == 1 ? 0 : std::numeric_limits<std::uint64_t>::max()) {}

Progress::~Progress() {
  if (!drawn_) return;
  std::fputs("\r\x1b[K", out_);
  std::fflush(out_);
}

void Progress::draw(std::uint64_t done) {
  constexpr std::size_t kWidth = 40;
  // Doubles: done * 100 would overflow in integers for the largest totals.
  const double percents = std::min(100.0, 100.0 * static_cast<double>(done) / static_cast<double>(total_));
  const auto percent = static_cast<unsigned>(percents);
  const auto full = static_cast<std::size_t>(percents) * kWidth / 100;
  const std::string line =
      fmt::format("\r{} [{}{}] {:3} %", label_, std::string(full, '#'), std::string(kWidth - full, '.'), percent);
  std::fputs(line.c_str(), out_);
  std::fflush(out_);
  drawn_ = true;
  const double next = std::ceil(static_cast<double>(total_) * (percent + 1) / 100.0);
  next_ =
      percent >= 100 ? std::numeric_limits<std::uint64_t>::max() : std::max(done + 1, static_cast<std::uint64_t>(next));
}

}  // namespace steerid
