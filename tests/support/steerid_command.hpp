// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The command as a user calls it, in a folder of the test's own that goes when the test ends. Needs STEERID_COMMAND,
// the path of the program.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "support/temporary_folder.hpp"

namespace steerid::test {

class SteeridCommand : public ::testing::Test {
 protected:
  struct Ended {
    int exit_code;
    std::string out;
    std::string err;
  };

  /// Runs `steerid ARGUMENTS` in the folder.
  [[nodiscard]] Ended run(const std::string& arguments) const {
    const std::string line = "cd '" + folder().string() + "' && '" STEERID_COMMAND "' " + arguments + " >out 2>err";
    const int status = std::system(line.c_str());  // NOLINT(cert-env33-c): our own command with our own words
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read("out"), read("err")};
  }

  [[nodiscard]] std::string read(const std::string& file) const {
    std::stringstream text;
    text << std::ifstream(folder() / file).rdbuf();
    return text.str();
  }

  [[nodiscard]] bool exists(const std::string& file) const { return std::filesystem::exists(folder() / file); }

  void write(const std::string& file, const std::string& text) const { std::ofstream(folder() / file) << text; }

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

}  // namespace steerid::test
