// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Drives of a wheel that lacks nothing, with the stamps that real loggers write.
#include <gtest/gtest.h>

#include <string>

#include "gap/diagnosis/diagnosis.hpp"
#include "log/log_reader.hpp"
#include "support/shared_data.hpp"

namespace steerid::gap {
namespace {

class OddStamps : public testing::TestWithParam<const char*> {};

TEST_P(OddStamps, HideNothingAndInventNothing) {
  STEERID_SHARED_OR_SKIP(path, std::string("logs/") + GetParam() + ".csv");
  Simulation simulation;
  simulation.wheel = {0.1265, 1.725, 29.5};  // of the drive
  DiagnoseOptions options;
  options.figures = false;
  const Diagnosis diagnosis = diagnose(read_log(path, {}), simulation, options);
  EXPECT_EQ(diagnosis.verdict, "none");
  EXPECT_GT(diagnosis.ranking.front().probability, 0.8);  // calibrated: measured 0.89 and more
}

INSTANTIATE_TEST_SUITE_P(Loggers, OddStamps,
                         testing::Values("late_stamps_500hz", "lost_stamps_500hz", "jittered_100hz", "fifteen_gaps"),
                         [](const auto& one) { return std::string(one.param); });

}  // namespace
}  // namespace steerid::gap
