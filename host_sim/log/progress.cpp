// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "log/standard_output.hpp"

namespace steerid {

namespace {

constexpr double kLineEvery_s = 60;

/// ", 40 s left"; empty while there is too little to tell it from.
std::string left(double done, double took_s) {
  if (!(done > 0) || took_s < 2) return "";
  const double left_s = took_s * (1 - done) / done;
  if (left_s < 100) return fmt::format(", {:.0f} s left", left_s);
  if (left_s < 6000) return fmt::format(", {:.0f} min left", left_s / 60);
  return fmt::format(", {:.1f} h left", left_s / 3600);
}

}  // namespace

double Progress::steady_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Progress::Progress(std::string label, std::uint64_t total, std::FILE* out, std::function<double()> now_s)
    : label_(std::move(label)),
      total_(total),
      out_(out),
      now_s_(std::move(now_s)),
      began_s_(now_s_()),
      told_s_(began_s_),
      terminal_(isatty(fileno(out)) == 1),
      next_(total > 0 && !prints_nothing() ? 0 : std::numeric_limits<std::uint64_t>::max()) {}

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
  const double now_s = now_s_();
  const std::string rest = percent < 100 ? left(percents / 100, now_s - began_s_) : "";
  std::string line;
  if (terminal_) {
    line = fmt::format("\r{} [{}{}] {:3} %{}\x1b[K", label_, std::string(full, '#'), std::string(kWidth - full, '.'),
                       percent, rest);
    drawn_ = true;
  } else if (now_s - told_s_ >= kLineEvery_s) {
    line = fmt::format("{}: {} %{}\n", label_, percent, rest);
    told_s_ = now_s;
  }
  std::fputs(line.c_str(), out_);
  std::fflush(out_);
  const double next = std::ceil(static_cast<double>(total_) * (percent + 1) / 100.0);
  next_ =
      percent >= 100 ? std::numeric_limits<std::uint64_t>::max() : std::max(done + 1, static_cast<std::uint64_t>(next));
}

}  // namespace steerid
