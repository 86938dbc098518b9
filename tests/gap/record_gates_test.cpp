#include "gap/record_gates.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "log/bad_input.hpp"

namespace steerid {
namespace {

/// A fit that leaves `share` of the power of a sinusoidal angle off its zero, and knows no parameter.
BatchFit leaving(double share) {
  BatchFit fit;
  fit.stop = StopReason::kGradient;
  for (int i = 0; i < 1000; ++i) {
    const double phase = 0.02 * std::acos(-1.0) * i;
    fit.residual_rad.push_back(std::sqrt(share) * std::sin(phase));
    fit.angle_model_rad.push_back(3 + (1 - std::sqrt(share)) * std::sin(phase));
  }
  fit.residual_rad[10] = std::nan("");  // held out
  return fit;
}

TEST(RecordGates, ExcitedIsAMotionThatALinearWheelMakes) {
  const BatchFit nothing_known = leaving(0);
  EXPECT_EQ(require_excited(nothing_known, leaving(0.45)).size(), 3U);  // a note a parameter
  EXPECT_THROW((void)require_excited(nothing_known, leaving(0.55)), BadInput);
}

TEST(RecordGates, OneParameterThatIsKnownIsEnough) {
  BatchFit stiffness_known = leaving(0);
  stiffness_known.stiffness.state = ParameterState::kValid;
  EXPECT_EQ(require_excited(stiffness_known, leaving(0.9)).size(), 2U);
}

}  // namespace
}  // namespace steerid
