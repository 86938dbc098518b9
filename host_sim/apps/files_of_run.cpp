// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/files_of_run.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <system_error>
#include <vector>

#include "log/bad_input.hpp"

namespace steerid {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStandard = "-";

/// Its path, which it has before it is there as well, and where it is there, the file itself, whatever it is called.
/// Empty for what is no file of its own, such as a device or a terminal.
std::vector<std::string> keys_of(const fs::path& file) {
  if (file == kStandard) return {kStandard};
  std::vector<std::string> keys;
  struct stat status {};
  if (::stat(file.c_str(), &status) == 0) {
    if (!S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) return {};
    keys.push_back(fmt::format("inode {} {}", status.st_dev, status.st_ino));
  }
  std::error_code none;
  fs::path whole = fs::weakly_canonical(file, none);
  if (none || whole.is_relative()) whole = fs::absolute(file, none).lexically_normal();
  keys.push_back("path " + whole.string());
  return keys;
}

}  // namespace

void FilesOfRun::reads(const fs::path& file, const std::string& by) {
  for (const Key& key : keys_of(file)) {
    const auto [earlier, first] = read_.try_emplace(key, by, file);
    if (!first && key == kStandard) {
      throw BadOption(fmt::format("{}: expected standard input to be read once, {} reads it already; name a file", by,
                                  earlier->second.first));
    }
  }
}

void FilesOfRun::writes(const fs::path& file, const std::string& by) {
  const std::vector<Key> keys = keys_of(file);
  for (const Key& key : keys) {
    if (const auto input = read_.find(key); input != read_.end() && key != kStandard) {
      throw BadOption(fmt::format("{}: expected a file that is not read, found {}, which {} reads as {}; name another",
                                  by, file.string(), input->second.first, input->second.second.string()));
    }
    writes_standard_output_ = writes_standard_output_ || key == kStandard;
    if (const auto earlier = written_.find(key); earlier != written_.end()) {
      throw BadOption(fmt::format("{}: expected a file of its own, found {}, which {} writes too; name another", by,
                                  file.string(), earlier->second.first));
    }
  }
  for (const Key& key : keys) written_.try_emplace(key, by, file);
}

}  // namespace steerid
