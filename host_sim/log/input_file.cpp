// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/input_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "log/bad_input.hpp"

namespace steerid {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ > STDERR_FILENO) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

const char* kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

/// Opened without waiting for a pipe's other end.
int open_regular(const std::filesystem::path& file, std::string_view what) {
  if (file == "-") return STDIN_FILENO;
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0) {
    throw bad_input({.file = file.string(),
                     .expected = "a readable file",
                     .found = fmt::format("\"{}\"", std::strerror(errno)),
                     .advice = "check its name and permissions"});
  }
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor);
    const bool folder = S_ISDIR(status.st_mode);
    throw bad_input({.file = file.string(),
                     .expected = std::string(what),
                     .found = kind_of(status.st_mode),
                     .advice = folder ? "name the file in it" : "give a regular file, or - for standard input"});
  }
  return descriptor;
}

}  // namespace

void check_input_file(const std::filesystem::path& file, std::string_view what) {
  const Descriptor opened(open_regular(file, what));
}

std::string read_whole_file(const std::filesystem::path& file, std::string_view what, std::uint64_t most_bytes) {
  const Descriptor opened(open_regular(file, what));
  std::string bytes;
  constexpr std::size_t kBlock = std::size_t{1} << 16;
  for (;;) {
    const std::size_t had = bytes.size();
    bytes.resize(had + kBlock);
    const ssize_t got = ::read(opened.number(), bytes.data() + had, kBlock);
    if (got < 0 && errno == EINTR) {
      bytes.resize(had);
      continue;
    }
    if (got < 0) {
      throw bad_input({.file = file.string(),
                       .expected = "a readable file",
                       .found = fmt::format("\"{}\"", std::strerror(errno)),
                       .advice = "check the disk or copy the file anew"});
    }
    bytes.resize(had + static_cast<std::size_t>(got));
    if (got == 0) return bytes;
    if (bytes.size() > most_bytes) {
      throw bad_input({.file = file.string(),
                       .expected = fmt::format("{} of {} MiB or less", what, most_bytes >> 20U),
                       .found = "a longer one",
                       .advice = "check that it is the right file"});
    }
  }
}

}  // namespace steerid
