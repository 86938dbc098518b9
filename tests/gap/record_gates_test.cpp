#include "gap/record_gates.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "log/bad_input.hpp"

namespace steerid {
namespace {

BatchFit nothing_known() {
  BatchFit fit;
  fit.stop = StopReason::kGradient;
  return fit;
}

TEST(RecordGates, ExcitedIsAMotionThatALinearWheelMakes) {
  EXPECT_EQ(require_excited(nothing_known(), std::sqrt(0.45)).size(), 3U);  // a note a parameter
  EXPECT_THROW((void)require_excited(nothing_known(), std::sqrt(0.55)), BadInput);
}

TEST(RecordGates, OneParameterThatIsKnownIsEnough) {
  BatchFit stiffness_known = nothing_known();
  stiffness_known.stiffness.state = ParameterState::kValid;
  EXPECT_EQ(require_excited(stiffness_known, std::sqrt(0.9)).size(), 2U);
}

}  // namespace
}  // namespace steerid
