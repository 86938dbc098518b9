// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// expected_drive LOG.csv OUT: the in-process run that the daemon in the guest is held against. Writes OUT, one line a
// sample: the sample's integers, then identifier and bytes of every cyclic frame that the firmware's loop would send
// after it, in hex.
#include <cstdio>
#include <exception>
#include <vector>

#include "app/run_loop.hpp"
#include "backend/replayed.hpp"
#include "can/estimate_messages.hpp"
#include "log/log_reader.hpp"
#include "log/resample.hpp"

namespace {

using namespace steerid;

// An estimate before the first sample has the stamp 0: no sample may have it.
constexpr std::int64_t kStartUs = 1'000'000;

/// The replayed record, with every sample and estimate written down.
class WrittenDown : public ReplayedHal {
 public:
  WrittenDown(const Record& record, std::FILE* out) : ReplayedHal(record), out_(out) {}

  Status read_sample(Sample& sample) {
    const Status status = ReplayedHal::read_sample(sample);
    if (status == Status::kOk) {
      sample.stamp_us += kStartUs;
      std::fprintf(out_, "%lld %d %d %d %d %d %d %u %u", static_cast<long long>(sample.stamp_us), sample.angle_urad,
                   sample.torque_driver_mnm, sample.torque_motor_mnm, sample.torque_bar_mnm, sample.torque_rim_mnm,
                   sample.probe_mnm, unsigned{sample.sequence}, unsigned{sample.valid_bits});
    }
    return status;
  }

  Status publish(const Estimate& estimate) {
    constexpr std::size_t kEveryCycle = 5;
    const auto frames = messages_.next(estimate, {});
    for (const can::Frame& frame : frames.first(kEveryCycle)) {
      std::fprintf(out_, " %03x:", unsigned{frame.id});
      for (const std::uint8_t byte : frame.data) std::fprintf(out_, "%02x", unsigned{byte});
    }
    std::fputc('\n', out_);
    return Status::kOk;
  }

 private:
  std::FILE* out_;
  can::EstimateMessages messages_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    const Record record = resample_100hz(read_log(argv[1])).record;
    std::FILE* const out = std::fopen(argv[2], "w");
    if (out == nullptr) return 1;
    WrittenDown hal(record, out);
    IdentificationTask<float> task;
    const bool done = run_loop(hal, task) == Status::kOk;
    return std::fclose(out) == 0 && done ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
