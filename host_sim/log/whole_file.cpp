// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/whole_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

#include "log/bad_input.hpp"
#include "log/standard_output.hpp"
#include "log/unfinished_files.hpp"

namespace steerid {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 18;
constexpr mode_t kNewFileMode = 0666;  // the user's umask takes away from it

std::filesystem::path partial_name(const std::filesystem::path& target) {
  static std::atomic<unsigned> counter{0};
  return target.parent_path() /
         fmt::format(".{}.partial-{}-{}", target.filename().string(), getpid(), counter.fetch_add(1));
}

/// A pipe without a reader would be waited for: not here. What comes after the opening may wait.
int open_special(const std::filesystem::path& target) {
  const int descriptor = open(target.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (descriptor >= 0) (void)fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
  return descriptor;
}

}  // namespace

WholeFile::WholeFile(const std::filesystem::path& target) : target_(target) {
  std::error_code ignored;
  buffer_.reserve(kBufferBytes);
  if (target == "-") {
    target_ = "standard output";
    descriptor_ = open_standard_output();
    if (descriptor_ < 0) complain("an open standard output", errno);
    return;
  }
  if (std::filesystem::is_symlink(target_, ignored)) target_ = std::filesystem::weakly_canonical(target_, ignored);
  const std::filesystem::file_status status = std::filesystem::status(target_, ignored);
  if (std::filesystem::is_directory(status) || !target_.has_filename()) {
    throw bad_input({.file = target.string(),
                     .expected = "the name of a file to write",
                     .found = "a folder",
                     .advice = "name a file in it"});
  }
  const std::filesystem::path folder = target_.has_parent_path() ? target_.parent_path() : ".";
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw bad_input({.file = target.string(),
                     .expected = "an existing folder to write to",
                     .found = "no folder " + in_quotes(folder.string()),
                     .advice = "create it first"});
  }
  const bool replaces = std::filesystem::exists(status);
  if (replaces && !std::filesystem::is_regular_file(status)) {
    descriptor_ = open_special(target_);
  } else {
    partial_ = partial_name(target_);
    descriptor_ = open_unfinished(partial_, kNewFileMode);
    // A failure to copy the permissions is no reason to withhold the output.
    if (descriptor_ >= 0 && replaces) (void)!fchmod(descriptor_, static_cast<mode_t>(status.permissions()));
  }
  if (descriptor_ < 0) {
    partial_.clear();
    const bool unread = errno == ENXIO;
    complain(unread ? "a pipe that somebody reads" : "a folder that can be written to", errno);
  }
}

WholeFile::~WholeFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!partial_.empty()) remove_unfinished(partial_);
}

void WholeFile::write(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= kBufferBytes) flush();
}

void WholeFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) complain("room to write", errno);
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void WholeFile::commit() {
  flush();
  if (!partial_.empty()) {
    if (fsync(descriptor_) != 0) complain("a disk that takes the file", errno);
    if (!keep_unfinished(partial_, target_)) complain("a file that can be replaced", errno);
    partial_.clear();
  }
  const int closed = close(descriptor_);
  descriptor_ = -1;
  if (closed != 0) complain("a disk that takes the file", errno);
}

void WholeFile::complain(std::string_view what, int error) const {
  throw bad_input({.file = target_.string(),
                   .expected = std::string(what),
                   .found = fmt::format("\"{}\"", std::strerror(error)),
                   .advice = "choose another place or free this one"});
}

void write_whole_file(const std::filesystem::path& target, std::string_view text) {
  WholeFile file(target);
  file.write(text);
  file.commit();
}

}  // namespace steerid
