// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Square root without libm: the identifier must give the same bits on every processor it runs on, and must not pull a
// math library into the image. IEEE 754 asks of a processor's own square root what it asks of a division, the rounded
// true root, so that its bits are the same everywhere; where there is none, and in the compiler's constants, Newton's
// iteration from a guess that halves the exponent takes its place.
//
// Cost: one instruction of 14 cycles on a Cortex-M4F, in float; elsewhere the processor's. The iteration: 4 divisions
// in float, 5 in double, within 1 unit in the last place. Arguments that are zero, negative or not a number give 0,
// since a variance that rounding made negative has no deviation to speak of; so do subnormal ones, which a processor
// may flush to zero anyway. Infinity gives infinity, or no number by iteration.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace steerid {

namespace square_root_detail {

constexpr float by_iteration(float x) {
  float root = std::bit_cast<float>((std::bit_cast<std::uint32_t>(x) >> 1U) + 0x1fbd1df5U);
  for (int i = 0; i < 4; ++i) root = 0.5F * (root + x / root);
  return root;
}

constexpr double by_iteration(double x) {
  double root = std::bit_cast<double>((std::bit_cast<std::uint64_t>(x) >> 1U) + 0x1ff7a3bea91d9b1bULL);
  for (int i = 0; i < 5; ++i) root = 0.5 * (root + x / root);
  return root;
}

// The compiler's own is a call of libm for arguments below zero, which never come here: a hosted program links it, an
// image must not.
#if !defined(__arm__)
inline float by_processor(float x) { return __builtin_sqrtf(x); }
inline double by_processor(double x) { return __builtin_sqrt(x); }
#elif defined(__ARM_FP)
inline float by_processor(float x) {
  float root;
  asm("vsqrt.f32 %0, %1" : "=t"(root) : "t"(x));
  return root;
}
inline double by_processor(double x) { return by_iteration(x); }
#else
inline float by_processor(float x) { return by_iteration(x); }
inline double by_processor(double x) { return by_iteration(x); }
#endif

template <class Float>
constexpr Float of(Float x) {
  if (!(x >= std::numeric_limits<Float>::min())) return Float(0);
  return std::is_constant_evaluated() ? by_iteration(x) : by_processor(x);
}

}  // namespace square_root_detail

constexpr float square_root(float x) { return square_root_detail::of(x); }
constexpr double square_root(double x) { return square_root_detail::of(x); }

}  // namespace steerid
