// The command as a user meets it: exit codes and what stands on standard output and standard error.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace steerid {
namespace {

class Command : public ::testing::Test {
 protected:
  Command() : folder_(std::filesystem::path(::testing::TempDir()) / ("steerid_command_" + test_name())) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~Command() override { std::filesystem::remove_all(folder_); }

  struct Ended {
    int exit_code;
    std::string out;
    std::string err;
  };

  /// Runs `steerid ARGUMENTS` in a folder of the test's own.
  [[nodiscard]] Ended run(const std::string& arguments) const {
    const std::string line = "cd '" + folder_.string() + "' && '" STEERID_COMMAND "' " + arguments + " >out 2>err";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read("out"), read("err")};
  }

  [[nodiscard]] std::string read(const std::string& file) const {
    std::stringstream text;
    text << std::ifstream(folder_ / file).rdbuf();
    return text.str();
  }

  void write(const std::string& file, const std::string& text) const { std::ofstream(folder_ / file) << text; }

 private:
  static std::string test_name() { return ::testing::UnitTest::GetInstance()->current_test_info()->name(); }

  std::filesystem::path folder_;
};

TEST_F(Command, VersionAndHelpGoToStandardOutput) {
  const Ended version = run("--version");
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.out, "steerid " STEERID_VERSION "\n");
  const Ended help = run("--help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.out.find("Exit codes"), std::string::npos);
  EXPECT_EQ(help.err, "");
}

TEST_F(Command, NoSubcommandIsBadUsage) {
  const Ended ended = run("");
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_EQ(ended.out, "");
  EXPECT_EQ(ended.err, "steerid: A subcommand is required\nTry `steerid --help`.\n");
}

TEST_F(Command, UnknownSubcommandIsNamed) {
  const Ended ended = run("identfy");
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_EQ(ended.err, "steerid: there is no command or option identfy\nTry `steerid --help`.\n");
}

}  // namespace
}  // namespace steerid
