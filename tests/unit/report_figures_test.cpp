// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Charts as files for papers: how wide, with which words and numbers, and nothing beside them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "log/bad_input.hpp"
#include "report/figures.hpp"
#include "support/temporary_folder.hpp"

namespace steerid::report {
namespace {

namespace fs = std::filesystem;

void anywhere(const fs::path&) {}

class Figures : public ::testing::Test {
 protected:
  static Page page() {
    Page out{.title = "t", .parts = {}};
    out.parts.emplace_back(Headline{.verdict = "no chart"});
    out.parts.emplace_back(LineChart{.title = "Angle, <measured>",
                                     .x = {"Time", "s"},
                                     .y = {"Angle", "rad"},
                                     .series = {{"a < b & \"c\"", Meaning::kMeasured, {0, 0.5, 1}, {0.25, -1, 2}}}});
    out.parts.emplace_back(Bars{.title = "Shares",
                                .categories = {"one, two", "three"},
                                .value = {"Share", "%"},
                                .series = {{"share", Meaning::kPlain, {40, 60}, {30, 50}, {50, 70}}}});
    return out;
  }

  [[nodiscard]] std::string read(const char* name) const {
    std::ifstream in(folder() / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] fs::path folder() const { return folder_.path() / "figures"; }
  [[nodiscard]] std::set<std::string> files() const {
    std::set<std::string> out;
    for (const auto& entry : fs::directory_iterator(folder())) out.insert(entry.path().filename().string());
    return out;
  }

  test::TemporaryFolder folder_;
};

TEST_F(Figures, AreAPictureAndItsNumbersOfEachChart) {
  write_figures(folder(), page(), anywhere);
  EXPECT_EQ(files(), (std::set<std::string>{"01_angle_measured.csv", "01_angle_measured.svg", "02_shares.csv",
                                            "02_shares.svg"}));
  EXPECT_EQ(read("01_angle_measured.csv"), "Time (s),\"a < b & \"\"c\"\" (rad)\"\n0,0.25\n0.5,-1\n1,2\n");
  EXPECT_EQ(read("02_shares.csv"),
            "Category,share (%),\"share, low (%)\",\"share, high (%)\"\n\"one, two\",40,30,50\nthree,60,50,70\n");
  const std::string svg = read("01_angle_measured.svg");
  EXPECT_TRUE(svg.starts_with("<svg width=\"88.00mm\" height=\"")) << svg.substr(0, 100);
  for (const char* words : {">Time (s)<", ">Angle (rad)<", ">a &lt; b &amp; "}) {
    EXPECT_NE(svg.find(words), std::string::npos) << words;
  }
  EXPECT_NE(svg.find("#16202b"), std::string::npos);  // --measured of style.css, light
}

TEST_F(Figures, OfAWrittenPageAreThose) {
  write_figures(folder(), page(), anywhere);
  const std::string expected = read("02_shares.svg");
  fs::remove_all(folder());
  write_page(folder_.path() / "page.html", page());
  write_figures_of(folder_.path() / "page.html", folder(), anywhere);
  EXPECT_EQ(read("02_shares.svg"), expected);
}

TEST_F(Figures, WantNode) {
  const char* path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe)
  const std::string before = path == nullptr ? "" : path;
  ASSERT_EQ(::setenv("PATH", folder_.path().c_str(), 1), 0);  // NOLINT(concurrency-mt-unsafe)
  EXPECT_THROW(write_figures(folder(), page(), anywhere), BadInput);
  ASSERT_EQ(::setenv("PATH", before.c_str(), 1), 0);  // NOLINT(concurrency-mt-unsafe)
  EXPECT_FALSE(fs::exists(folder()));
}

}  // namespace
}  // namespace steerid::report
