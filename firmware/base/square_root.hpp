// Square root without libm: the identifier must give the same bits on every processor it runs on, and must not pull a
// math library into the image. Newton's iteration from a guess that halves the exponent.
//
// Cost: 4 divisions in float, 5 in double. Result within 1 unit in the last place of the true root. Arguments that are
// zero, negative or not a number give 0, since a variance that rounding made negative has no deviation to speak of;
// so do subnormal ones, which a processor may flush to zero anyway. Infinity gives no number.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

namespace steerid {

constexpr float square_root(float x) {
  if (!(x >= std::numeric_limits<float>::min())) return 0.0F;
  float root = std::bit_cast<float>((std::bit_cast<std::uint32_t>(x) >> 1U) + 0x1fbd1df5U);
  for (int i = 0; i < 4; ++i) root = 0.5F * (root + x / root);
  return root;
}

constexpr double square_root(double x) {
  if (!(x >= std::numeric_limits<double>::min())) return 0.0;
  double root = std::bit_cast<double>((std::bit_cast<std::uint64_t>(x) >> 1U) + 0x1ff7a3bea91d9b1bULL);
  for (int i = 0; i < 5; ++i) root = 0.5 * (root + x / root);
  return root;
}

}  // namespace steerid
