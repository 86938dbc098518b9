// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Preloaded into a program, it makes the N-th call by which that program changes a folder fail, or sends a signal
// there.
//
//   FAILING_FOLDER   only what is below it counts
//   FAILING_PROGRAM  only the process of this name counts, as /proc/self/comm has it
//   FAILING_CALL     N, from 1
//   FAILING_HOW      "full": this call and all after it fail with ENOSPC, as on a disk that is full; else the number of
//   a
//                    signal that the process gets during the call. A write or fsync then never comes back: what the
//                    signal does is all that happens. Other calls may hold a lock that whoever handles the signal
//                    needs.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::string own_name() {
  char name[64] = "";
  if (std::FILE* file = std::fopen("/proc/self/comm", "r")) {
    if (std::fgets(name, sizeof name, file) != nullptr) name[std::strcspn(name, "\n")] = '\0';
    std::fclose(file);
  }
  return name;
}

/// Whether it is the N-th call or, on a full disk, one after it.
bool fails(const std::string& path, bool may_block) {
  static const std::string folder = variable("FAILING_FOLDER");
  static const bool counts = own_name() == variable("FAILING_PROGRAM");
  static const long failing = std::atol(variable("FAILING_CALL").c_str());
  static const std::string how = variable("FAILING_HOW");
  static std::atomic<long> calls{0};
  if (!counts || path.rfind(folder, 0) != 0) return false;
  const long call = ++calls;
  if (how == "full") {
    if (call < failing) return false;
    errno = ENOSPC;
    return true;
  }
  if (call != failing) return false;
  ::kill(::getpid(), std::atoi(how.c_str()));
  while (may_block) ::pause();
  return false;
}

std::string whole(const char* path) {
  if (path[0] == '/') return path;
  char here[PATH_MAX];
  return ::getcwd(here, sizeof here) == nullptr ? std::string(path) : std::string(here) + "/" + path;
}

std::string path_of(int descriptor) {
  char path[PATH_MAX];
  const ssize_t length = ::readlink(("/proc/self/fd/" + std::to_string(descriptor)).c_str(), path, sizeof path);
  return length < 0 ? "" : std::string(path, static_cast<std::size_t>(length));
}

template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

int open_by(const char* name, const char* path, int flags, mode_t mode) {
  if ((flags & (O_CREAT | O_TRUNC)) != 0 && fails(whole(path), false)) return -1;
  return real<int(const char*, int, ...)>(name)(path, flags, mode);
}

mode_t mode_of(int flags, std::va_list list) { return (flags & O_CREAT) != 0 ? va_arg(list, mode_t) : 0; }

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  std::va_list list;
  va_start(list, flags);
  const mode_t mode = mode_of(flags, list);
  va_end(list);
  return open_by("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  std::va_list list;
  va_start(list, flags);
  const mode_t mode = mode_of(flags, list);
  va_end(list);
  return open_by("open64", path, flags, mode);
}

ssize_t write(int descriptor, const void* bytes, size_t count) {
  if (fails(path_of(descriptor), true)) return -1;
  return real<ssize_t(int, const void*, size_t)>("write")(descriptor, bytes, count);
}

int fsync(int descriptor) {
  if (fails(path_of(descriptor), true)) return -1;
  return real<int(int)>("fsync")(descriptor);
}

int mkdir(const char* path, mode_t mode) noexcept {
  if (fails(whole(path), false)) return -1;
  return real<int(const char*, mode_t)>("mkdir")(path, mode);
}

int rename(const char* from, const char* to) noexcept {
  if (fails(whole(to), false)) return -1;
  return real<int(const char*, const char*)>("rename")(from, to);
}
}
