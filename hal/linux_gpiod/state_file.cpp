// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "linux_gpiod/state_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>

#include "linux_gpiod/failure.hpp"

namespace steerid::linux_gpiod {
namespace {

constexpr off_t kSlotBytes = 4096;

}  // namespace

StateFile::StateFile(const std::string& path)
    : file_(::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0640)) {
  const int why = errno;
  const std::string cannot = "cannot open the state file " + path + ": ";
  if (!file_.open() && why == ELOOP) throw Failure(cannot + "it is a symbolic link; name the file itself");
  if (!file_.open() && why == EISDIR) throw Failure(cannot + "it is a folder; name a file in it");
  if (!file_.open()) {
    throw Failure(cannot + reason(why, "the daemon's user must be able to write it") + "; its folder must exist");
  }
  struct stat what {};
  if (::fstat(file_.number(), &what) != 0 || !S_ISREG(what.st_mode)) {
    throw Failure(cannot + "it is no regular file; name one, or one to be made");
  }
}

Status StateFile::read_bytes(int slot, void* bytes, std::size_t count) {
  return ::pread(file_.number(), bytes, count, slot * kSlotBytes) >= 0 ? Status::kOk : Status::kIoError;
}

Status StateFile::write_bytes(int slot, const void* bytes, std::size_t count) {
  const bool written = ::pwrite(file_.number(), bytes, count, slot * kSlotBytes) == static_cast<ssize_t>(count);
  return written && ::fdatasync(file_.number()) == 0 ? Status::kOk : Status::kIoError;
}

}  // namespace steerid::linux_gpiod
