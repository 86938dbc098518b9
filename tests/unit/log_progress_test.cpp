// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "log/progress.hpp"

namespace steerid::test {
namespace {

TEST(Progress, SaysALineAMinuteInAPipe) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  std::FILE* out = fdopen(ends[1], "w");
  {
    double now_s = 1000;
    Progress progress("working", 10, out, [&] { return now_s; });
    for (std::uint64_t done = 0; done <= 10; ++done, now_s += 25) progress.at(done);
  }
  std::fclose(out);
  std::array<char, 1024> text{};
  const ssize_t got = read(ends[0], text.data(), text.size());
  close(ends[0]);
  // 10 % take 25 s: a line after 75, 150 and 225 s, and then 100 s for the last 40 %.
  EXPECT_EQ(std::string(text.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0))),
            "working: 30 %, 3 min left\nworking: 60 %, 2 min left\nworking: 90 %, 25 s left\n");
}

TEST(Progress, IsSilentInAPipeForAMinute) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  std::FILE* out = fdopen(ends[1], "w");
  {
    Progress progress("working", 10, out);
    for (std::uint64_t done = 0; done <= 10; ++done) progress.at(done);
  }
  std::fclose(out);
  char byte = 0;
  EXPECT_EQ(read(ends[0], &byte, 1), 0) << "something was written";
  close(ends[0]);
}

/// What a terminal receives while `work` draws on it.
template <typename Work>
std::string on_terminal(Work work) {
  const int controller = posix_openpt(O_RDWR | O_NOCTTY);
  if (controller < 0 || grantpt(controller) != 0 || unlockpt(controller) != 0) return {};
  std::array<char, 128> name{};
  if (ptsname_r(controller, name.data(), name.size()) != 0) return {};
  std::FILE* terminal = std::fopen(name.data(), "w");
  work(terminal);
  std::fclose(terminal);
  std::string text;
  std::array<char, 4096> part{};
  for (ssize_t got = 0; (got = read(controller, part.data(), part.size())) > 0;) {
    text.append(part.data(), static_cast<std::size_t>(got));
  }
  close(controller);
  return text;
}

TEST(Progress, DrawsOnATerminalAndWipesItsLine) {
  const std::string text = on_terminal([](std::FILE* terminal) {
    double now_s = 0;
    Progress progress("working", 4, terminal, [&] { return now_s; });
    progress.at(0);
    now_s = 10;
    progress.at(1);
    progress.at(1);  // nothing new
    progress.at(4);
  });
  if (text.empty()) GTEST_SKIP() << "no pseudo terminal here";
  EXPECT_EQ(text, "\rworking [" + std::string(40, '.') + "]   0 %\x1b[K" +                                        //
                      "\rworking [" + std::string(10, '#') + std::string(30, '.') + "]  25 %, 30 s left\x1b[K" +  //
                      "\rworking [" + std::string(40, '#') + "] 100 %\x1b[K\r\x1b[K");
}

TEST(Progress, DrawsAtMostOncePerPercent) {
  const std::string text = on_terminal([](std::FILE* terminal) {
    Progress progress("w", 1'000'000, terminal);
    for (std::uint64_t done = 0; done <= 1'000'000; ++done) progress.at(done);
  });
  if (text.empty()) GTEST_SKIP() << "no pseudo terminal here";
  std::size_t drawn = 0;
  for (std::size_t at = 0; (at = text.find("\rw [", at)) != std::string::npos; ++at) ++drawn;
  EXPECT_EQ(drawn, 101U);
}

}  // namespace
}  // namespace steerid::test
