// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/sealed_key.hpp"

#include <cstdint>

#include "log/bad_input.hpp"
#include "log/input_file.hpp"
#include "log/output_folder.hpp"
#include "log/whole_file.hpp"

namespace steerid {
namespace {

constexpr std::uint64_t kMostBytesOfKey = std::uint64_t{64} << 20;  // 100,000 records take 40

std::string read(const std::filesystem::path& file) {
  return read_whole_file(file, "a file of a blind study", kMostBytesOfKey);
}

}  // namespace

std::string seal(const std::filesystem::path& folder, std::string_view key) {
  const std::filesystem::path sealed = folder / "sealed";
  make_output_folder(sealed);
  write_whole_file(sealed / "key.json", key);
  std::filesystem::permissions(sealed, std::filesystem::perms::owner_all);
  const std::string hash = sha256(key);
  write_whole_file(folder / "KEY_SHA256", hash + "  sealed/key.json\n");
  return hash;
}

std::string open_seal(const std::filesystem::path& folder) {
  const std::string key = read(folder / "sealed" / "key.json");
  const std::string published = read(folder / "KEY_SHA256").substr(0, 64);
  if (sha256(key) != published) {
    throw bad_input({.file = (folder / "sealed" / "key.json").string(),
                     .expected = "the key with the SHA-256 in KEY_SHA256",
                     .found = "another one",
                     .advice = "the answers have changed since they were sealed: draw anew"});
  }
  return key;
}

}  // namespace steerid
