// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/own_process.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "log/standard_output.hpp"
#include "log/unfinished_files.hpp"

namespace steerid {

int run_own_process(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {"steerid"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  if (prints_nothing()) words.emplace_back("--quiet");
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  (void)std::fflush(stdout);
  pid_t child = 0;
  const int error = ::posix_spawn(&child, "/proc/self/exe", nullptr, nullptr, pointers.data(), environ);
  if (error != 0) throw std::runtime_error(std::string("cannot start another steerid: ") + std::strerror(error));
  const EndsWithProgram with_this_one(child);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR)
      throw std::runtime_error(std::string("cannot wait for another steerid: ") + std::strerror(errno));
  }
  if (!WIFEXITED(status)) throw std::runtime_error("another steerid died: " + words.at(1));
  return WEXITSTATUS(status);
}

}  // namespace steerid
