// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/unfinished_files.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <set>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace steerid {
namespace {

/// Never destroyed: a signal may come while the program's own objects go.
struct Unfinished {
  std::mutex lock;
  std::set<std::string> files;
  std::set<std::filesystem::path> folders;
  std::set<pid_t> children;
};

Unfinished& unfinished() {
  static auto* const kAll = new Unfinished;
  return *kAll;
}

sigset_t& waited_for() {
  static sigset_t set = [] {
    sigset_t empty;
    sigemptyset(&empty);
    return empty;
  }();
  return set;
}

/// Until they have gone, for at most a second.
void wait_for_children() {
  for (const pid_t child : unfinished().children) {
    for (int tries = 0; tries < 100 && ::waitpid(child, nullptr, WNOHANG) == 0; ++tries) ::usleep(10'000);
  }
}

[[noreturn]] void end_by(int signal) {
  unfinished().lock.lock();  // for good: whoever wants to make a file now waits for the end
  for (const std::string& file : unfinished().files) ::unlink(file.c_str());
  for (const pid_t child : unfinished().children) ::kill(child, signal);
  for (const std::filesystem::path& folder : unfinished().folders) {
    wait_for_children();  // which may be writing there
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }
  ::signal(signal, SIG_DFL);
  pthread_sigmask(SIG_UNBLOCK, &waited_for(), nullptr);
  ::kill(::getpid(), signal);
  for (;;) ::pause();
}

}  // namespace

void end_tidily_on_signals() {
  ::signal(SIGPIPE, SIG_IGN);
  ::signal(SIGXFSZ, SIG_IGN);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction now {};
    sigaction(signal, nullptr, &now);
    if (now.sa_handler != SIG_IGN) sigaddset(&waited_for(), signal);
  }
  pthread_sigmask(SIG_BLOCK, &waited_for(), nullptr);
  std::thread([] {
    int signal = 0;
    while (sigwait(&waited_for(), &signal) != 0) continue;
    end_by(signal);
  }).detach();
}

int open_unfinished(const std::filesystem::path& path, mode_t mode) {
  const std::lock_guard guard(unfinished().lock);
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (descriptor >= 0) unfinished().files.insert(path.string());
  return descriptor;
}

bool link_unfinished(const std::filesystem::path& from, const std::filesystem::path& path) {
  const std::lock_guard guard(unfinished().lock);
  if (::link(from.c_str(), path.c_str()) != 0) return false;
  unfinished().files.insert(path.string());
  return true;
}

bool keep_unfinished(const std::filesystem::path& path, const std::filesystem::path& target) {
  const std::lock_guard guard(unfinished().lock);
  if (std::rename(path.c_str(), target.c_str()) != 0) return false;
  unfinished().files.erase(path.string());
  return true;
}

void remove_unfinished(const std::filesystem::path& path) {
  const std::lock_guard guard(unfinished().lock);
  const int before = errno;
  ::unlink(path.c_str());
  errno = before;
  unfinished().files.erase(path.string());
}

ScratchFolder::ScratchFolder(std::filesystem::path path) : path_(std::move(path)) {
  const std::lock_guard guard(unfinished().lock);
  std::filesystem::create_directory(path_);
  unfinished().folders.insert(path_);
}

ScratchFolder::~ScratchFolder() {
  const std::lock_guard guard(unfinished().lock);
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
  unfinished().folders.erase(path_);
}

EndsWithProgram::EndsWithProgram(pid_t child) : child_(child) {
  const std::lock_guard guard(unfinished().lock);
  unfinished().children.insert(child_);
}

EndsWithProgram::~EndsWithProgram() {
  const std::lock_guard guard(unfinished().lock);
  unfinished().children.erase(child_);
}

void restore_signals_in_child() {
  ::signal(SIGPIPE, SIG_DFL);
  ::signal(SIGXFSZ, SIG_DFL);
  sigprocmask(SIG_UNBLOCK, &waited_for(), nullptr);
}

}  // namespace steerid
