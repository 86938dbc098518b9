// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The number that a kernel works with inside: for float and double the number itself, for Fixed a LooseFixed.
//
// Half of what an operation of Fixed costs is bringing its result back into the format and looking whether it fits. A
// kernel that makes one number out of many operations needs that at its end only. So
//
//   LooseFixed<N>   value = mantissa / 2^29 * 2^exponent,   |mantissa| <= N 2^29, as small as it comes
//   product         N is the product of both N; rounded once. Of two tight numbers at least 27 bits are left
//   sum             N is the sum of both N; the smaller operand is cut off at the last place of the larger
//   rounded_sum()   the same with the smaller operand rounded
//   tight()         back to N = 1, 2^28 <= |mantissa|
//   reciprocal_of() a tight number above zero, within 2^-27 of it
//
// N is part of the type and at most 3: that nothing overflows 32 bits is proved where the kernel is compiled. What
// cancels stays where it was: the difference of two numbers is as exact as the larger of them, as with Fixed. Exponents
// are not held, and take more than a kernel can reach; on the way back to Fixed a number is held and counted.
//
// Cost on a Cortex-M3, instructions: product 5, sum 10, tight 6, reciprocal 14 (docs/benchmarks.md).
#pragma once

#include <bit>
#include <cstdint>

#include "base/fixed.hpp"

namespace steerid {

template <int N = 1>
class LooseFixed {
  static_assert(N >= 1 && N <= 3, "the mantissa would not fit 32 bits");

 public:
  constexpr LooseFixed() = default;
  constexpr explicit LooseFixed(Fixed x) requires(N == 1) : mantissa_(x.mantissa()), exponent_(x.exponent() + 29) {}
  constexpr LooseFixed(std::int32_t mantissa, std::int32_t exponent) : mantissa_(mantissa), exponent_(exponent) {}
  template <int M>
  requires(M < N) constexpr explicit(false) LooseFixed(LooseFixed<M> x)
      : mantissa_(x.mantissa()), exponent_(x.exponent()) {}
  constexpr explicit operator Fixed() const { return Fixed::scaled(mantissa_, exponent_ - 29); }

  [[nodiscard]] constexpr std::int32_t mantissa() const { return mantissa_; }
  [[nodiscard]] constexpr std::int32_t exponent() const { return exponent_; }

  constexpr LooseFixed operator-() const { return {-mantissa_, exponent_}; }

 private:
  std::int32_t mantissa_{0};
  /// Of zero as Fixed has it: so far below every other that alignment shifts nothing but the zero.
  std::int32_t exponent_{Fixed().exponent() + 29};
};

template <int N, int M>
constexpr LooseFixed<N * M> operator*(LooseFixed<N> a, LooseFixed<M> b) {
  return {fixed_detail::rounded_product<29>(a.mantissa(), b.mantissa()), a.exponent() + b.exponent()};
}
template <int N, int M>
constexpr LooseFixed<N + M> operator+(LooseFixed<N> a, LooseFixed<M> b) {
  // A shift by 31 leaves no more than the sign.
  const std::int32_t above = a.exponent() - b.exponent();
  if (above < 0) return {(a.mantissa() >> fixed_detail::held_to_31(-above)) + b.mantissa(), b.exponent()};
  return {a.mantissa() + (b.mantissa() >> fixed_detail::held_to_31(above)), a.exponent()};
}
/// a + b, the smaller one rounded: for what is summed up over many samples, since what is cut off adds up.
template <int N, int M>
constexpr LooseFixed<N + M> rounded_sum(LooseFixed<N> a, LooseFixed<M> b) {
  const std::int32_t above = a.exponent() - b.exponent();
  if (above < 0) {
    const std::int32_t places = fixed_detail::held_to_31(-above);
    return {fixed_detail::rounded_sum(b.mantissa(), a.mantissa(), places), b.exponent()};
  }
  const std::int32_t places = fixed_detail::held_to_31(above);
  return {fixed_detail::rounded_sum(a.mantissa(), b.mantissa(), places), a.exponent()};
}
template <int N, int M>
constexpr LooseFixed<N + M> operator-(LooseFixed<N> a, LooseFixed<M> b) {
  return a + -b;
}

namespace loose_detail {
/// Of a mantissa moved up until it fills its 32 bits. With N = 1 its last two bits are zero: there is nothing to round.
template <int N>
constexpr std::int32_t quarter(std::int32_t up) {
  if constexpr (N == 1) return up >> 2;
  return fixed_detail::rounded_quarter(up);
}
}  // namespace loose_detail

/// Of what is known not to be below zero.
template <int N>
constexpr LooseFixed<> tight_positive(LooseFixed<N> x) {
  const int room = std::countl_zero(static_cast<std::uint32_t>(x.mantissa())) - 1;
  const std::int32_t up = x.mantissa() << room;
  return {loose_detail::quarter<N>(up), x.exponent() + 2 - room};
}
template <int N>
constexpr LooseFixed<> tight(LooseFixed<N> x) {
  const auto size = static_cast<std::uint32_t>(x.mantissa() ^ (x.mantissa() >> 31));
  const int room = std::countl_zero(size) - 1;
  const auto up = static_cast<std::int32_t>(static_cast<std::uint32_t>(x.mantissa()) << static_cast<unsigned>(room));
  return {loose_detail::quarter<N>(up), x.exponent() + 2 - room};
}

constexpr LooseFixed<> reciprocal_of(LooseFixed<> x) {
  const std::uint32_t inverse = Fixed::inverse_of<57>(static_cast<std::uint32_t>(x.mantissa()));
  return {static_cast<std::int32_t>(inverse), 1 - x.exponent()};
}

namespace kernel_detail {
template <class Scalar>
struct Number {
  using Type = Scalar;
};
template <>
struct Number<Fixed> {
  using Type = LooseFixed<>;
};
}  // namespace kernel_detail

/// What a kernel over Scalar works with inside.
template <class Scalar>
using KernelNumber = typename kernel_detail::Number<Scalar>::Type;

// The same words for the numbers that need none of it.
constexpr float tight(float x) { return x; }
constexpr double tight(double x) { return x; }
constexpr float tight_positive(float x) { return x; }
constexpr double tight_positive(double x) { return x; }
constexpr float rounded_sum(float a, float b) { return a + b; }
constexpr double rounded_sum(double a, double b) { return a + b; }
constexpr float reciprocal_of(float x) { return 1.0F / x; }
constexpr double reciprocal_of(double x) { return 1.0 / x; }

}  // namespace steerid
