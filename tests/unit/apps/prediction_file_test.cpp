// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The angle of somebody else's simulator at a record's stamps, by a closed form.
#include "apps/prediction_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "log/bad_input.hpp"
#include "support/temporary_folder.hpp"

namespace steerid {
namespace {

double angle_rad(double t) { return 0.1 * std::sin(3 * t); }

class PredictionFile : public ::testing::Test {
 protected:
  PredictionFile() {
    for (int i = 0; i < 2000; ++i) {
      record_.time_s.push_back(0.01 * i);
      record_.angle_rad.push_back(angle_rad(0.01 * i));
    }
  }

  /// Of `count` rows `apart_s` apart.
  [[nodiscard]] std::vector<double> read(int count, double apart_s, double begin_s = 0) const {
    const std::filesystem::path file = folder_.path() / "pred.csv";
    std::ofstream out(file);
    out << "time_s,angle_rad\n";
    for (int i = 0; i < count; ++i) {
      const double t = begin_s + apart_s * i;
      out << fmt::format("{:.6f},{:.9f}\n", t, angle_rad(t));
    }
    out.close();
    return read_prediction(file, record_);
  }

  test::TemporaryFolder folder_;
  Record record_;
};

/// The record's last sample is at 19.99 s: at 50 rows a second the prediction's last one is at 19.98 s.
TEST_F(PredictionFile, AtAnotherRateReachesAsFarAsItsLastPeriod) {
  for (const double rate_hz : {50.0, 100.0, 200.0}) {
    const std::vector<double> found = read(static_cast<int>(20 * rate_hz), 1 / rate_hz);
    ASSERT_EQ(found.size(), record_.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], record_.angle_rad[i], 1e-4) << rate_hz;
  }
  EXPECT_EQ(read(999, 0.02, 0.01).size(), record_.size());  // and begins a period late
}

TEST_F(PredictionFile, ThatEndsEarlierOrBeginsLaterIsRefused) {
  EXPECT_THROW((void)read(998, 0.02), BadInput);
  EXPECT_THROW((void)read(1000, 0.02, 0.05), BadInput);
}

}  // namespace
}  // namespace steerid
