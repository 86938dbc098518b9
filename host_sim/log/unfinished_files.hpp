// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What has to go when the program is ended in mid-work: files that are not whole yet, and processes that it started.
//
// After end_tidily_on_signals() a SIGINT, SIGTERM or SIGHUP removes every unfinished file, passes the signal on to the
// children, and then ends the program as the signal would have done, so that a shell sees 130, 143 or 129. A signal
// that the caller had ignored (nohup) stays ignored. A pipe that nobody reads any more and a file beyond the user's
// size limit become errors of the write in place of the signals SIGPIPE and SIGXFSZ.
//
// A thread of its own waits for the signals, so that all of this is ordinary code under a lock, and no file can appear
// after the others were removed.
#pragma once

#include <sys/types.h>

#include <filesystem>

namespace steerid {

/// To be called once, before the program starts a thread.
void end_tidily_on_signals();

/// Makes the file `path`, for writing, and removes it when a signal ends the program. Returns the descriptor, or -1
/// with errno set.
[[nodiscard]] int open_unfinished(const std::filesystem::path& path, mode_t mode);

/// Makes the file `path` another name of `from`, and removes that name when a signal ends the program. False with errno
/// set when that fails, as between two disks.
[[nodiscard]] bool link_unfinished(const std::filesystem::path& from, const std::filesystem::path& path);

/// Renames it over `target`: from then on it stays. False with errno set when that fails; it is unfinished still then.
[[nodiscard]] bool keep_unfinished(const std::filesystem::path& path, const std::filesystem::path& target);

/// Removes it.
void remove_unfinished(const std::filesystem::path& path);

/// A folder that goes with all that is in it, also when a signal ends the program. Throws std::filesystem_error when it
/// cannot be made.
class ScratchFolder {
 public:
  explicit ScratchFolder(std::filesystem::path path);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A child process that is ended together with this one.
class EndsWithProgram {
 public:
  explicit EndsWithProgram(pid_t child);
  ~EndsWithProgram();
  EndsWithProgram(const EndsWithProgram&) = delete;
  EndsWithProgram& operator=(const EndsWithProgram&) = delete;

 private:
  pid_t child_;
};

/// For a child before it becomes another program: signals reach it again as they reached this program at first.
void restore_signals_in_child();

}  // namespace steerid
