// The guard process and what it writes, without lines; with them it is tested in tests/linux_guest.
#include "linux_ecu/guard.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
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
