// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// steerid-ecu as one starts it: what it says of configs that are none, and how it ends. In a kernel with a GPIO chip:
// tests/linux_guest.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "support/temporary_folder.hpp"

namespace steerid::linux_ecu {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct Answer {
  int exit_code = -1;
  std::string said;
  [[nodiscard]] auto lines() const { return std::count(said.begin(), said.end(), '\n'); }
};

/// Ends what takes longer than 5 s, with exit code 124.
Answer run(const std::string& arguments) {
  const std::string command = "timeout 5 " STEERID_ECU " " + arguments + " 2>&1 >/dev/null";
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  Answer answer;
  std::array<char, 4096> text{};
  for (std::size_t bytes = 0; (bytes = std::fread(text.data(), 1, text.size(), pipe)) > 0;) {
    answer.said.append(text.data(), bytes);
  }
  const int status = ::pclose(pipe);
  answer.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return answer;
}

class EcuCommand : public testing::Test {
 protected:
  [[nodiscard]] std::string config(const std::string& text) const {
    std::ofstream(path()) << text;
    return "--config " + path() + " --dry-run";
  }
  [[nodiscard]] std::string path() const { return folder_.path() / "ecu.json"; }

  test::TemporaryFolder folder_;
};

TEST_F(EcuCommand, SaysInOneSentenceWhatIsWrongWithAConfigThatIsNone) {
  const std::string nested(30'000, '[');
  const std::array<std::pair<std::string, const char*>, 9> bad{{
      {config(""), "is empty; it needs at least {\"can\": \"can0\"}"},
      {"--config /dev/null --dry-run", "is no regular file"},
      {"--config /dev/zero --dry-run", "is no regular file"},
      {"--config /tmp --dry-run", "is no regular file"},
      {"--config /no/such/file --dry-run", "No such file"},
      {"--config '' --dry-run", "No such file"},
      {"--config /etc/shadow/ecu.json --dry-run", "Not a directory"},
      {"--config /proc/self/mem --dry-run", "cannot read the config file"},
      {"--config /dev/zero --make-safe", "is no regular file"},
  }};
  for (const auto& [arguments, said] : bad) {
    const Answer answer = run(arguments);
    EXPECT_EQ(answer.exit_code, 1) << arguments;
    EXPECT_THAT(answer.said, AllOf(HasSubstr(said), Not(HasSubstr("Success")), Not(HasSubstr("internal"))))
        << arguments;
    EXPECT_EQ(answer.lines(), 1) << arguments;
  }
}

TEST_F(EcuCommand, SaysInOneSentenceWhatIsWrongInAConfig) {
  const std::array<std::pair<std::string, const char*>, 7> bad{{
      {" \n\t\n", "is empty"},
      {"{\"can\": \"can0\", \"priority\": 1e999}", "holds a number that is too large"},
      {"{\"can\": \"can0\",\n\"wheel\": -1e999}", "holds a number that is too large"},
      {"{\"can\": \"can0\",\n\"can\": \"can1\"}", "ecu.json:2: \"can\" stands twice"},
      {std::string(30'000, '['), "is not JSON"},
      {std::string(20'000, '[') + std::string(20'000, ']'), "must be an object"},
      {"{\"can\": \"can0\"}" + std::string(70'000, ' '), "larger than 64 KiB"},
  }};
  for (const auto& [text, said] : bad) {
    const Answer answer = run(config(text));
    const std::string begin = text.substr(0, 40);
    EXPECT_EQ(answer.exit_code, 1) << begin;
    EXPECT_THAT(answer.said, HasSubstr(said)) << begin;
    EXPECT_EQ(answer.lines(), 1) << begin;
  }
}

TEST_F(EcuCommand, APipeWithoutAPartnerIsRefusedAndNotWaitedFor) {
  ASSERT_EQ(::mkfifo(path().c_str(), 0600), 0);
  const Answer answer = run("--config " + path() + " --dry-run");
  EXPECT_EQ(answer.exit_code, 1);
  EXPECT_THAT(answer.said, HasSubstr("is no regular file"));
}

TEST_F(EcuCommand, MakeSafeSaysWhyItCannotAndThatItCould) {
  static_cast<void>(config(R"({"can": "can0", "lines": {"valid": {"chip": "gpiochip77", "line": 1},
                               "fault": {"line": "NO_SUCH_LINE"}}})"));
  const Answer cannot = run("--config " + path() + " --make-safe");
  EXPECT_EQ(cannot.exit_code, 1);
  EXPECT_THAT(cannot.said, AllOf(HasSubstr("not every output"), HasSubstr("gpiochip77"), HasSubstr("NO_SUCH_LINE")));
  EXPECT_EQ(cannot.lines(), 1);
  static_cast<void>(config(R"({"can": "can0"})"));
  const Answer could = run("--config " + path() + " --make-safe");
  EXPECT_EQ(could.exit_code, 0);
  EXPECT_THAT(could.said, HasSubstr("the outputs are at their safe levels"));
}

}  // namespace
}  // namespace steerid::linux_ecu
