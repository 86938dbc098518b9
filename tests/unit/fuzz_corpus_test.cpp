// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The fuzz targets' entry point on their corpus and on mutations of it, with the ordinary compiler: what a fuzzer once
// found stays found.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "support/seed.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace steerid::test {
namespace {

void run(const std::string& text) {
  EXPECT_EQ(LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()), 0);
}

/// The corpus in the order of its names: a folder lists them in any.
std::vector<std::string> corpus() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(STEERID_CORPUS)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> texts;
  for (const auto& path : paths) {
    std::ifstream in(path, std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return texts;
}

TEST(FuzzCorpus, EveryInput) {
  const std::vector<std::string> texts = corpus();
  EXPECT_GE(texts.size(), 5U) << "the corpus is not where it should be";
  for (const std::string& text : texts) run(text);
  run("");
}

TEST(FuzzCorpus, EveryInputCutShort) {
  for (const std::string& text : corpus()) {
    for (std::size_t length = 0; length < std::min<std::size_t>(text.size(), 400); ++length)
      run(text.substr(0, length));
  }
}

TEST(FuzzCorpus, MutationsOfEveryInput) {
  constexpr std::string_view alphabet("\0\n\r\t ,;\"#+-.:|=eEinfa0159\xef\xbb\xff", 28);
  std::mt19937_64 bits(seed(11));
  for (const std::string& text : corpus()) {
    for (int variant = 0; variant < 200 && !text.empty(); ++variant) {
      std::string mutated = text;
      for (int change = 0; change < 1 + variant % 4; ++change) {
        const std::size_t at = bits() % mutated.size();
        const char other = alphabet[bits() % alphabet.size()];
        switch (bits() % 3) {
          case 0:
            mutated[at] = other;
            break;
          case 1:
            mutated.insert(at, 1, other);
            break;
          default:
            mutated.insert(at, mutated.substr(bits() % mutated.size(), bits() % 64));
        }
      }
      run(mutated);
    }
  }
}

}  // namespace
}  // namespace steerid::test
