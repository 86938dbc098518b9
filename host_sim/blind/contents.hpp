// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What is to be in the drawn cases: which effects, and which of them their simulations have.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace steerid::blind {

/// How a case's simulation has an effect.
enum class Simulated {
  kNot,      ///< the wheel has it alone
  kAsItIs,   ///< with the wheel's own numbers
  kResized,  ///< the wheel has it of another size
  kAlone,    ///< the wheel has it not
};

struct Content {
  std::string id;  ///< of an effect, none, or parameters
  Simulated simulated = Simulated::kNot;

  Content(std::string of, Simulated how = Simulated::kNot) : id(std::move(of)), simulated(how) {}  // NOLINT: a word
  Content(const char* of) : id(of) {}                                                              // NOLINT: likewise
  friend bool operator==(const Content&, const Content&) = default;
};

/// What is to be in a case: none, parameters, or up to four effects.
using Contents = std::vector<Content>;

/// `count` contents in an order that the seed decides. A deck holds every effect of the vocabulary twice, `none` and
/// `parameters` four times each and every effect outside the vocabulary once; decks follow each other.
[[nodiscard]] std::vector<Contents> draw_contents(std::size_t count, std::uint64_t seed);

/// Two effects of the vocabulary at once, of different families, neither of them simulated.
[[nodiscard]] std::vector<Contents> draw_pairs(std::size_t count, std::uint64_t seed);

/// Up to four effects of different families, which the simulation has, has of another size, has not, or has alone. A
/// deck of 20 holds every one of the cases that several_case() names, those that users meet most more than once.
[[nodiscard]] std::vector<Contents> draw_several(std::size_t count, std::uint64_t seed);

/// The contents with an effect outside the vocabulary beside what has to change: a remainder, as every real machine
/// leaves one. Contents in which no effect has to change stay as they are.
[[nodiscard]] std::vector<Contents> with_remainders(std::vector<Contents> all, std::uint64_t seed);

/// What has to change, in words, as far as the vocabulary goes: "exact", "resized", "superfluous", "2 missing", "1
/// missing beside 2", or "mixed".
[[nodiscard]] std::string several_case(const Contents& contents);

}  // namespace steerid::blind
