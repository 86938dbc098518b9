// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Fixed: the number that the identifier runs on where there is no floating-point unit. Integers only.
//
//   value = mantissa * 2^exponent,   2^28 <= |mantissa| <= 2^29,   -156 <= exponent <= 98;   zero apart
//
// Each value carries its own binary format, a Q format with 28 fraction bits and a scale. One format for all would not
// do: in the course of a drive the elements of the covariance span 20 decades, 68 bits (docs/fixed_point.md).
//
//   resolution   2^-28 of the value, worst; every operation is rounded to the nearest, halves towards plus infinity
//   range        2^-128 to 2^127, about that of float; below it a result is zero
//   overflow     a result beyond the range is held at its end with its sign and counted; nothing ever wraps. So is a
//                division by zero; 0 / 0 is 0. Overflows come in `overflow_count()`, one for the image; it saturates
//   error        * 0.5 units in the last place of the result, / 0.76, square_root 1; + and - 1 unit of the larger of
//                operand and result; x * 1, x + 0, x / x and x - x are exact
//   cost         Cortex-M3, instructions with the call: * 15, + 24, / 46, square_root 46 (docs/benchmarks.md)
//
// Same bits on every processor and by every compiler: there is nothing here but 32-bit additions, shifts and products
// of 64 bits. A Fixed is made of a double by the compiler only, so that no image contains a floating-point helper.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>

// On a Cortex-M the operations are called: inlined a thousand times they would not fit the flash. Their operands and
// results travel in two registers each, as the halves of 64 bits.
#ifdef __thumb__
#define STEERID_CALLED [[gnu::noinline]]
#else
#define STEERID_CALLED
#endif

namespace steerid {

namespace fixed_detail {

/// product / 2^Shift, rounded to the nearest, halves towards plus infinity; Shift from 1 to 31, the result within 32
/// bits. The last bit that a processor shifts out is its carry, and the carry is what rounding adds: two instructions
/// of Arm.
template <int Shift>
constexpr std::int32_t rounded(std::int64_t product) {
#ifdef __thumb2__
  if (!std::is_constant_evaluated()) {
    const auto low = static_cast<std::uint32_t>(product);
    const auto high = static_cast<std::int32_t>(product >> 32);
    std::int32_t result;
    asm("lsrs %0, %1, %3\n\tadc %0, %0, %2, lsl %4"
        : "=&r"(result)
        : "r"(low), "r"(high), "I"(Shift), "I"(32 - Shift)
        : "cc");
    return result;
  }
#endif
  return static_cast<std::int32_t>((product + (1LL << (Shift - 1))) >> Shift);
}

/// a b / 2^Shift likewise.
template <int Shift>
constexpr std::int32_t rounded_product(std::int32_t a, std::int32_t b) {
#ifdef __thumb2__
  if (!std::is_constant_evaluated()) {
    std::int32_t result, high;
    asm("smull %0, %1, %2, %3\n\tlsrs %0, %0, %4\n\tadc %0, %0, %1, lsl %5"
        : "=&r"(result), "=&r"(high)
        : "r"(a), "r"(b), "I"(Shift), "I"(32 - Shift)
        : "cc");
    return result;
  }
#endif
  return rounded<Shift>(static_cast<std::int64_t>(a) * b);
}

/// x / 4 likewise.
constexpr std::int32_t rounded_quarter(std::int32_t x) {
#ifdef __thumb2__
  if (!std::is_constant_evaluated()) {
    std::int32_t result;
    asm("asrs %0, %1, #2\n\tadc %0, %0, #0" : "=r"(result) : "r"(x) : "cc");
    return result;
  }
#endif
  return ((x >> 1) + 1) >> 1;
}

/// large + small / 2^places, the quotient rounded likewise; places from 0 to 31, the result within 32 bits.
constexpr std::int32_t rounded_sum(std::int32_t large, std::int32_t small, std::int32_t places) {
#ifdef __thumb2__
  if (!std::is_constant_evaluated()) {
    std::int32_t result;
    // A shift by no place leaves the carry as it is: cleared before.
    asm("cmn %3, #0\n\tasrs %0, %2, %3\n\tadc %0, %0, %1" : "=&r"(result) : "r"(large), "r"(small), "r"(places) : "cc");
    return result;
  }
#endif
  const auto half = static_cast<std::int32_t>((1U << static_cast<unsigned>(places)) >> 1U);
  return large + static_cast<std::int32_t>((static_cast<std::int64_t>(small) + half) >> places);
}

/// Held from 0 to 31, by which 32 bits can be shifted: one instruction of Arm.
constexpr std::int32_t held_to_31(std::int32_t x) {
  if (x < 0) return 0;
  return x > 31 ? 31 : x;
}

}  // namespace fixed_detail

class Fixed {
 public:
  static constexpr int kFractionBits = 28;
  static constexpr std::int32_t kLeastMantissa = 1 << kFractionBits;
  static constexpr std::int32_t kMostMantissa = 1 << (kFractionBits + 1);
  static constexpr std::int32_t kLeastExponent = -156;
  static constexpr std::int32_t kMostExponent = 98;

  constexpr Fixed() = default;
  /// Rounded to 29 bits; exact up to 2^29.
  template <std::signed_integral Integer>
  requires(sizeof(Integer) <= sizeof(std::int32_t)) constexpr explicit(false) Fixed(Integer integer) {
    *this = normalised(integer, 0);
  }
  /// A constant of the source. At run time there are no doubles.
  consteval explicit Fixed(double constant) { *this = of_double(constant); }

  /// Of any mantissa within int64 and any exponent within +-10000: rounded, and held at the ends of the range.
  static constexpr Fixed scaled(std::int64_t mantissa, std::int32_t exponent);
  static constexpr Fixed largest() { return Fixed(kMostMantissa - 1, kMostExponent); }

  [[nodiscard]] constexpr std::int32_t mantissa() const { return static_cast<std::int32_t>(bits_); }
  [[nodiscard]] constexpr std::int32_t exponent() const { return static_cast<std::int32_t>(bits_ >> 32U); }
  /// Towards zero; beyond int32 its end, counted.
  template <std::signed_integral Integer>
  requires(sizeof(Integer) == sizeof(std::int32_t)) [[nodiscard]] constexpr explicit operator Integer() const {
    return static_cast<Integer>(whole());
  }

  /// 2^Power / divisor within 2^-27.5 of it, and not above; 2^28 <= divisor <= 2^29, 45 <= Power <= 59. Newton's
  /// iteration, from below.
  template <unsigned Power>
  static constexpr std::uint32_t inverse_of(std::uint32_t divisor) {
    // Twice the error fits 32 bits, so that it is got from a wrapped product.
    const std::uint32_t first = UINT32_MAX / ((divisor >> 13U) + 1U);  // 2^45 / divisor within 2^-14
    const std::uint32_t error = 0U - divisor * first;                  // 2^45 - divisor first
    const auto rest = static_cast<std::uint32_t>((static_cast<std::uint64_t>(first) * error) >> 32U);  // 2^58 / divisor
    if constexpr (Power > 58) {
      return (first << (Power - 45U)) + (rest << (Power - 58U));
    } else {
      return (first << (Power - 45U)) + (rest >> (58U - Power));
    }
  }

  /// Results that did not fit, since the start of the image or since the count was cleared.
  static std::uint32_t overflow_count() { return overflows_; }
  static void clear_overflow_count() { overflows_ = 0; }

  friend constexpr Fixed operator*(Fixed a, Fixed b) { return of(product(bits(a), bits(b))); }
  friend constexpr Fixed operator/(Fixed a, Fixed b) { return of(quotient(bits(a), bits(b))); }
  friend constexpr Fixed operator+(Fixed a, Fixed b) { return of(sum(bits(a), bits(b))); }
  friend constexpr Fixed operator-(Fixed a, Fixed b) { return of(sum(bits(a), bits(-b))); }
  constexpr Fixed operator-() const { return Fixed(-mantissa(), exponent()); }
  constexpr Fixed operator+() const { return *this; }
  constexpr Fixed& operator+=(Fixed b) { return *this = *this + b; }
  constexpr Fixed& operator-=(Fixed b) { return *this = *this - b; }
  constexpr Fixed& operator*=(Fixed b) { return *this = *this * b; }
  constexpr Fixed& operator/=(Fixed b) { return *this = *this / b; }

  friend constexpr bool operator<(Fixed a, Fixed b) { return compare(bits(a), bits(b)) < 0; }
  friend constexpr bool operator>(Fixed a, Fixed b) { return compare(bits(a), bits(b)) > 0; }
  friend constexpr bool operator<=(Fixed a, Fixed b) { return compare(bits(a), bits(b)) <= 0; }
  friend constexpr bool operator>=(Fixed a, Fixed b) { return compare(bits(a), bits(b)) >= 0; }
  friend constexpr bool operator==(Fixed a, Fixed b) { return compare(bits(a), bits(b)) == 0; }
  friend constexpr bool operator!=(Fixed a, Fixed b) { return compare(bits(a), bits(b)) != 0; }

  /// Zero for zero and below: a variance that rounding made negative has no deviation to speak of.
  friend constexpr Fixed square_root(Fixed x) { return of(root(bits(x))); }

 private:
  /// Of zero: so far below every other that alignment shifts a zero out, and that a product with it is out of range.
  static constexpr std::int32_t kZeroExponent = -2048;

  constexpr Fixed(std::int32_t mantissa, std::int32_t exponent)
      : bits_(static_cast<std::uint64_t>(static_cast<std::uint32_t>(exponent)) << 32U |
              static_cast<std::uint32_t>(mantissa)) {}

  /// Mantissa below, exponent above.
  using Bits = std::uint64_t;
  static constexpr Bits bits(Fixed x) { return x.bits_; }
  static constexpr Fixed of(Bits x) {
    Fixed made;
    made.bits_ = x;
    return made;
  }

  [[nodiscard]] constexpr std::int32_t whole() const;
  STEERID_CALLED static constexpr Bits product(Bits a_bits, Bits b_bits) {
    const Fixed a = of(a_bits);
    const Fixed b = of(b_bits);
    return bits(rounded<28>(static_cast<std::int64_t>(a.mantissa()) * b.mantissa(), a.exponent() + b.exponent()));
  }
  STEERID_CALLED static constexpr Bits quotient(Bits a_bits, Bits b_bits) {
    const Fixed a = of(a_bits);
    const Fixed b = of(b_bits);
    if (b.mantissa() == 0) [[unlikely]]
      return bits(divided_by_zero(a));
    const std::uint32_t divisor = magnitude(b.mantissa());
    std::uint32_t inverse = inverse_of<59>(divisor);
    const std::uint32_t rest = 0U - divisor * inverse;  // 2^59 - divisor inverse
    inverse += static_cast<std::uint32_t>((static_cast<std::uint64_t>(inverse) * rest + (1ULL << 58U)) >> 59U);
    const std::int64_t scaled_up = static_cast<std::int64_t>(a.mantissa()) * inverse;  // 2^59 a / b
    const Fixed result = rounded<30>(scaled_up, a.exponent() - b.exponent() - 59);
    return bits(b.mantissa() < 0 ? -result : result);
  }
  STEERID_CALLED static constexpr Bits sum(Bits a_bits, Bits b_bits) {
    const Fixed a = of(a_bits);
    const Fixed b = of(b_bits);
    std::int32_t large = a.mantissa();
    std::int32_t small = b.mantissa();
    std::int32_t top = a.exponent();
    std::int32_t shift = top - b.exponent();
    if (shift < 0) {
      large = b.mantissa();
      small = a.mantissa();
      top = b.exponent();
      shift = -shift;
    }
    shift = fixed_detail::held_to_31(shift);
    return bits(normalised<true>(fixed_detail::rounded_sum(large, small, shift), top));
  }
  STEERID_CALLED static constexpr Bits root(Bits x_bits) {
    const Fixed x = of(x_bits);
    if (x.mantissa() <= 0) return bits(Fixed());
    const bool odd = (x.exponent() & 1) != 0;
    const std::uint32_t square = static_cast<std::uint32_t>(x.mantissa()) << (odd ? 1U : 0U);  // 2^28 to 2^30
    // Newton from the line through sqrt at 2^28 and 2^30; 15 bits after three steps, 30 after the long one.
    std::uint32_t guess = 10923U + (square >> 15U) * 2U / 3U;
    guess = (guess + square / guess) >> 1U;
    guess = (guess + square / guess) >> 1U;
    guess = (guess + square / guess) >> 1U;
    const std::uint32_t high = square / guess;
    const std::uint32_t rest = ((square - high * guess) << 15U) / guess;
    const std::uint32_t fine = ((guess << 14U) + (high << 14U) + (rest >> 1U));  // sqrt(square) 2^15
    const std::int32_t exponent = (x.exponent() - (odd ? 1 : 0)) / 2;            // even: exact
    return bits(normalised<true>(static_cast<std::int32_t>(fine), exponent - 15));
  }
  /// -1, 0 or 1, exactly.
  STEERID_CALLED static constexpr int compare(Bits a_bits, Bits b_bits) {
    const Fixed a = of(a_bits);
    const Fixed b = of(b_bits);
    const std::int32_t shift = a.exponent() - b.exponent();
    std::int32_t left = a.mantissa();
    std::int32_t right = b.mantissa();
    // Beyond 2^1 the larger exponent decides, whatever the mantissas, and zero never has it.
    if (shift > 1) right = 0;
    if (shift == 1) left *= 2;
    if (shift == -1) right *= 2;
    if (shift < -1) left = 0;
    return left < right ? -1 : left > right ? 1 : 0;
  }
  /// Rounds a mantissa of any size. What is called itself asks for `Leaf`: see held().
  template <bool Leaf = false>
  static constexpr Fixed normalised(std::int32_t mantissa, std::int32_t exponent);
  /// Rounds a product of 2^(28 + Shift) to 2^(30 + Shift), or zero.
  template <int Shift>
  static constexpr Fixed rounded(std::int64_t product, std::int32_t exponent) {
    const auto cut = static_cast<std::int32_t>(product >> Shift);
    if (static_cast<std::uint32_t>(cut) + static_cast<std::uint32_t>(kMostMantissa) <
        static_cast<std::uint32_t>(kMostMantissa) * 2) {
      return in_range<true>(fixed_detail::rounded<Shift>(product), exponent + Shift);
    }
    return in_range<true>(fixed_detail::rounded<Shift + 1>(product), exponent + Shift + 1);
  }
  /// A mantissa that is in its range already, or zero; any exponent.
  template <bool Leaf>
  static constexpr Fixed in_range(std::int32_t mantissa, std::int32_t exponent) {
    constexpr auto kSpan = static_cast<std::uint32_t>(kMostExponent - kLeastExponent);
    if (static_cast<std::uint32_t>(exponent - kLeastExponent) > kSpan) [[unlikely]] {
      if constexpr (Leaf) return of(held(mantissa, exponent));
      return of(held_by_call(mantissa, exponent));
    }
    return Fixed(mantissa, exponent);
  }
  // Where a whole operation is called this is part of it: a call, seldom as it is, would have it save registers at
  // every pass. Where an operation is inlined it is the other way round.
  [[gnu::always_inline]] static constexpr Bits held(std::int32_t mantissa, std::int32_t exponent);
  [[gnu::cold, gnu::noinline]] static constexpr Bits held_by_call(std::int32_t mantissa, std::int32_t exponent) {
    return held(mantissa, exponent);
  }
  [[gnu::cold]] static constexpr Fixed divided_by_zero(Fixed a);
  static constexpr void count_overflow() {
    if (!std::is_constant_evaluated() && overflows_ < UINT32_MAX) ++overflows_;
  }
  static constexpr std::uint32_t magnitude(std::int32_t mantissa) {
    return mantissa < 0 ? 0U - static_cast<std::uint32_t>(mantissa) : static_cast<std::uint32_t>(mantissa);
  }
  static consteval Fixed of_double(double constant);

  inline static constinit std::uint32_t overflows_ = 0;

  // One word of 64 bits and not two of 32: compilers keep it in two registers, and a struct of two in memory.
  std::uint64_t bits_ = static_cast<std::uint64_t>(static_cast<std::uint32_t>(kZeroExponent)) << 32U;
};

constexpr Fixed::Bits Fixed::held(std::int32_t mantissa, std::int32_t exponent) {
  if (mantissa == 0 || exponent < kLeastExponent) return bits(Fixed());
  count_overflow();
  return bits(mantissa < 0 ? -largest() : largest());
}

constexpr Fixed Fixed::divided_by_zero(Fixed a) {
  count_overflow();
  if (a.mantissa() == 0) return a;
  return a.mantissa() < 0 ? -largest() : largest();
}

template <bool Leaf>
constexpr Fixed Fixed::normalised(std::int32_t mantissa, std::int32_t exponent) {
  if (mantissa == 0) return Fixed();
  // The copies of the sign in front, the sign itself apart.
  const int room = std::countl_zero(static_cast<std::uint32_t>(mantissa ^ (mantissa >> 31))) - 1;
  // All the way up, then down by two with the last bit rounded: a mantissa with two bits of room is exact.
  const std::int32_t up = static_cast<std::int32_t>(static_cast<std::uint32_t>(mantissa) << room);
  return in_range<Leaf>(fixed_detail::rounded_quarter(up), exponent + 2 - room);
}

constexpr Fixed Fixed::scaled(std::int64_t mantissa, std::int32_t exponent) {
  // What is shifted out stays known by a last bit of one, so that the rounding at the end is the only one: it drops
  // two.
  while (mantissa > INT32_MAX || mantissa < INT32_MIN) {
    mantissa = (mantissa >> 1) | (mantissa & 1);
    ++exponent;
  }
  return normalised(static_cast<std::int32_t>(mantissa), exponent);
}

constexpr std::int32_t Fixed::whole() const {
  if (exponent() >= 2) {
    if (mantissa() == -kMostMantissa && exponent() == 2) return INT32_MIN;
    if (exponent() > 2 || mantissa() >= kMostMantissa) {
      count_overflow();
      return mantissa() < 0 ? INT32_MIN : INT32_MAX;
    }
    return mantissa() * 4;
  }
  if (exponent() >= 0) return mantissa() * (1 << exponent());
  if (exponent() < -30) return 0;
  const auto cut = static_cast<std::int32_t>(magnitude(mantissa()) >> static_cast<unsigned>(-exponent()));
  return mantissa() < 0 ? -cut : cut;
}

consteval Fixed Fixed::of_double(double constant) {
  const auto ieee = std::bit_cast<std::uint64_t>(constant);
  const auto biased = static_cast<std::int32_t>((ieee >> 52U) & 0x7FFU);
  if (biased == 0) return Fixed();
  const auto significand = static_cast<std::int64_t>((ieee & 0xFFFFFFFFFFFFFULL) | (1ULL << 52U));
  return scaled((ieee >> 63U) != 0U ? -significand : significand, biased - 1075);
}

}  // namespace steerid

#undef STEERID_CALLED

/// What generic code asks of a number. Never a float: `is_iec559` is false.
template <>
class std::numeric_limits<steerid::Fixed> {
 public:
  static constexpr bool is_specialized = true;
  static constexpr bool is_signed = true;
  static constexpr bool is_integer = false;
  static constexpr bool is_exact = false;
  static constexpr bool is_iec559 = false;
  static constexpr bool has_infinity = false;
  static constexpr bool has_quiet_NaN = false;
  static constexpr int radix = 2;
  static constexpr int digits = steerid::Fixed::kFractionBits;
  static constexpr int digits10 = 8;
  static constexpr steerid::Fixed max() { return steerid::Fixed::largest(); }
  static constexpr steerid::Fixed lowest() { return -steerid::Fixed::largest(); }
  static constexpr steerid::Fixed min() { return steerid::Fixed::scaled(1, -128); }
  static constexpr steerid::Fixed epsilon() { return steerid::Fixed::scaled(1, -28); }
};
