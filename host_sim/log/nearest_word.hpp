// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The word that a misspelt one was probably meant to be.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace steerid {

/// The nearest of `words` by insertions, deletions, replacements and swaps of neighbours; nothing when none is within
/// a third of the word's length, and when two are equally near in different words.
[[nodiscard]] std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& words);

/// "; did you mean WORD?", or nothing.
[[nodiscard]] std::string did_you_mean(std::string_view word, const std::vector<std::string>& words);

}  // namespace steerid
