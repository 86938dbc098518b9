// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The guard process and what it writes, without lines; with them it is tested in tests/linux_guest.
#include "linux_ecu/guard.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "linux_ecu/notify.hpp"
#include "linux_gpiod/failure.hpp"
#include "linux_gpiod/state_file.hpp"

namespace steerid::linux_ecu {
namespace {

using linux_gpiod::StateFile;

class GuardTest : public testing::Test {
 protected:
  GuardTest() {
    std::string folder = testing::TempDir() + "guardXXXXXX";
    EXPECT_NE(::mkdtemp(folder.data()), nullptr);
    folder_ = folder;
    config_.state_file = folder_ / "estimate";
  }
  ~GuardTest() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
  Config config_;
  const SavedEstimate estimate_{
      .value_micro = {110'000, 1'500'000, 22'000'000}, .sd_micro = {1'000, 10'000, 100'000}, .noise_unm = 30'000};
};

/// The one child of this process called steerid-guard.
pid_t guard_process() {
  std::ifstream children("/proc/self/task/" + std::to_string(::getpid()) + "/children");
  pid_t child = 0;
  children >> child;
  return child;
}

/// Kicks slowly, so that the guard has read all in the end.
void await_all_read(Guard& guard) {
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(guard.kick(), Status::kOk);
    ::usleep(5'000);
  }
}

TEST_F(GuardTest, WritesTheEstimateThatTheNextStartReads) {
  {
    Guard guard(config_);
    EXPECT_EQ(guard.kick(), Status::kOk);
    EXPECT_EQ(guard.save(estimate_), Status::kOk);
  }
  StateFile file(config_.state_file);
  SavedEstimate read;
  ASSERT_EQ(TwoSlots<StateFile>(file, config_.wheel).load(read), Status::kOk);
  EXPECT_EQ(read, estimate_);
}

TEST_F(GuardTest, AKickSaysWhenTheGuardIsGone) {
  Guard guard(config_);
  ASSERT_EQ(guard.kick(), Status::kOk);
  const pid_t process = guard_process();
  ASSERT_GT(process, 0);
  ASSERT_EQ(::kill(process, SIGKILL), 0);
  for (int i = 0; i < 200 && guard.kick() == Status::kOk; ++i) ::usleep(5'000);
  EXPECT_EQ(guard.kick(), Status::kIoError);
}

TEST_F(GuardTest, AGuardThatStandsStillCountsAsGoneAfterASecondOfKicksAndIsEnded) {
  const auto begin = std::chrono::steady_clock::now();
  pid_t process = 0;
  {
    Guard guard(config_);
    ASSERT_EQ(guard.kick(), Status::kOk);
    process = guard_process();
    ASSERT_GT(process, 0);
    await_all_read(guard);
    ASSERT_EQ(::kill(process, SIGSTOP), 0);
    int kicks = 0;
    while (kicks < 1000 && guard.kick() == Status::kOk) ++kicks;
    EXPECT_GE(kicks, Guard::kDeadKicks - 1);
    EXPECT_LE(kicks, Guard::kDeadKicks + 1);
    EXPECT_EQ(guard.kick(), Status::kIoError);
  }
  EXPECT_EQ(::kill(process, 0), -1);
  EXPECT_EQ(errno, ESRCH);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(3));
}

TEST_F(GuardTest, AGuardThatReadsLateIsAlive) {
  Guard guard(config_);
  ASSERT_EQ(guard.kick(), Status::kOk);
  await_all_read(guard);
  const pid_t process = guard_process();
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(::kill(process, SIGSTOP), 0);
    for (int kick = 0; kick < Guard::kDeadKicks * 3 / 4; ++kick) ASSERT_EQ(guard.kick(), Status::kOk) << kick;
    ASSERT_EQ(::kill(process, SIGCONT), 0);
    await_all_read(guard);
  }
}

TEST_F(GuardTest, AMediumThatHoldsAWriteUpDoesNotHoldTheGuardUp) {
  // A lease on the file makes whoever opens it wait until it is given back, as a slow medium does.
  ASSERT_EQ(TwoSlots<StateFile>(*std::make_unique<StateFile>(config_.state_file), 1).save(estimate_), Status::kOk);
  std::signal(SIGIO, SIG_IGN);
  const linux_gpiod::Descriptor held(::open(config_.state_file.c_str(), O_RDWR | O_CLOEXEC));
  if (::fcntl(held.number(), F_SETLEASE, F_WRLCK) != 0) GTEST_SKIP() << "no leases on this file system";
  SavedEstimate newest = estimate_;
  {
    Guard guard(config_);
    ASSERT_EQ(guard.kick(), Status::kOk);
    ASSERT_EQ(guard.save(estimate_), Status::kOk);
    newest.noise_unm = 40'000;
    ASSERT_EQ(guard.save(newest), Status::kOk);  // waits for the one before
    for (int kick = 0; kick < 2 * Guard::kDeadKicks; ++kick) {
      ASSERT_EQ(guard.kick(), Status::kOk) << kick;
      ::usleep(2'000);
    }
    ASSERT_EQ(::fcntl(held.number(), F_SETLEASE, F_UNLCK), 0);
  }
  StateFile file(config_.state_file);
  SavedEstimate read;
  ASSERT_EQ(TwoSlots<StateFile>(file, config_.wheel).load(read), Status::kOk);
  EXPECT_EQ(read, newest);
}

TEST_F(GuardTest, AStateFileThatIsALinkIsRefusedAndWhatItPointsToLeftAlone) {
  const std::filesystem::path precious = folder_ / "precious";
  std::ofstream(precious) << "precious";
  std::filesystem::create_symlink(precious, config_.state_file);
  try {
    StateFile file(config_.state_file);
    FAIL() << "followed";
  } catch (const linux_gpiod::Failure& failure) {
    EXPECT_NE(std::string(failure.what()).find("it is a symbolic link; name the file itself"), std::string::npos);
  }
  {
    Guard guard(config_);
    EXPECT_EQ(guard.kick(), Status::kOk);
    EXPECT_EQ(guard.save(estimate_), Status::kOk);
  }
  EXPECT_EQ(std::filesystem::file_size(precious), 8U);
  std::filesystem::remove(config_.state_file);
  std::filesystem::create_symlink(folder_ / "not_there", config_.state_file);
  EXPECT_THROW(StateFile{config_.state_file}, linux_gpiod::Failure);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "not_there"));
}

TEST_F(GuardTest, AStateFileThatIsNoFileIsRefused) {
  EXPECT_THROW(StateFile("/dev/null"), linux_gpiod::Failure);
  ASSERT_EQ(::mkfifo(config_.state_file.c_str(), 0600), 0);
  EXPECT_THROW(StateFile{config_.state_file}, linux_gpiod::Failure);
}

TEST_F(GuardTest, AStateFileOfAnotherWheelOrCutShortIsNotRead) {
  StateFile file(config_.state_file);
  SavedEstimate read;
  EXPECT_EQ(TwoSlots<StateFile>(file, 1).load(read), Status::kNoData);
  ASSERT_EQ(TwoSlots<StateFile>(file, 1).save(estimate_), Status::kOk);
  EXPECT_EQ(TwoSlots<StateFile>(file, 2).load(read), Status::kOutOfRange);
  for (std::uintmax_t bytes = 1; bytes < kSavedBytes; ++bytes) {
    std::filesystem::resize_file(config_.state_file, bytes);
    EXPECT_EQ(TwoSlots<StateFile>(file, 1).load(read), Status::kCorrupt) << bytes;
  }
}

TEST_F(GuardTest, AStateFileInAFolderThatIsNotThereIsRefusedWithAReason) {
  EXPECT_THROW(StateFile("/no/such/folder/estimate"), linux_gpiod::Failure);
}

TEST(Notify, ReachesTheSocketThatSystemdNames) {
  const linux_gpiod::Descriptor systemd(::socket(AF_UNIX, SOCK_DGRAM, 0));
  const std::string name = "steerid-test-" + std::to_string(::getpid());
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  name.copy(address.sun_path + 1, name.size());
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  ASSERT_EQ(::bind(systemd.number(), reinterpret_cast<const sockaddr*>(&address), length), 0);
  ::setenv("NOTIFY_SOCKET", ("@" + name).c_str(), 1);
  Notify().tell("READY=1");
  ::unsetenv("NOTIFY_SOCKET");
  char text[32] = {};
  ASSERT_GT(::recv(systemd.number(), text, sizeof text - 1, MSG_DONTWAIT), 0);
  EXPECT_STREQ(text, "READY=1");
  Notify().tell("READY=1");  // nobody listens: nothing happens
  EXPECT_LT(::recv(systemd.number(), text, sizeof text, MSG_DONTWAIT), 0);
}

}  // namespace
}  // namespace steerid::linux_ecu
