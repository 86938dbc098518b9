// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What every reader of files promises a fuzzer: an answer that keeps its promises, or one sentence.
#pragma once

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace steerid::fuzz {

/// A broken promise stops the fuzzer here, in release builds too.
inline void promise(bool kept, const char* what) {
  if (kept) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

/// Of less than `most` bytes: a message's own definition may stand in one.
inline void check_sentence(std::string_view sentence, std::size_t most = 4096) {
  promise(!sentence.empty() && sentence.size() < most, "a sentence of reasonable length");
  for (const char c : sentence) {
    const auto byte = static_cast<unsigned char>(c);
    promise(byte >= 0x20 && byte != 0x7f, "a sentence of one line without control characters");
  }
}

}  // namespace steerid::fuzz
