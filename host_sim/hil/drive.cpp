// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "hil/drive.hpp"

#include <algorithm>
#include <array>

#include "app/run_loop.hpp"
#include "app/saving_hal.hpp"
#include "backend/replayed.hpp"
#include "identifier/fixed_in_eigen.hpp"

namespace steerid::hil {
namespace {

/// The ECU's two saved pages.
class Pages {
 public:
  Pages() {
    for (SavedRecord& page : pages_) page.fill(0xFF);
  }
  Status read(int slot, SavedRecord& into) {
    into = pages_[static_cast<std::size_t>(slot)];
    return Status::kOk;
  }
  Status write(int slot, const SavedRecord& from) {
    pages_[static_cast<std::size_t>(slot)] = from;
    return Status::kOk;
  }

 private:
  std::array<SavedRecord, 2> pages_;
};

/// A stretch of ticks between two resets, behind the port.
class Stretch {
 public:
  Stretch(const std::vector<TickInput>& ticks, std::size_t begin, std::vector<Estimate>& estimates)
      : ticks_(&ticks), next_(begin), estimates_(&estimates) {}

  Status wait_tick() {
    if (next_ == ticks_->size() || (any_ && (*ticks_)[next_].reset_before)) return Status::kEndOfStream;
    any_ = true;
    ++next_;
    return Status::kOk;
  }
  Status read_sample(Sample& sample) {
    const std::optional<Sample>& here = (*ticks_)[next_ - 1].sample;
    if (!here) return Status::kNoData;
    sample = *here;
    return Status::kOk;
  }
  Status publish(const Estimate& estimate) {
    estimates_->push_back(estimate);
    return Status::kOk;
  }
  Status request_probe_torque(std::int32_t) { return Status::kOutOfRange; }
  void set_valid(bool) {}
  void set_fault(bool) {}
  void kick_watchdog() {}

  [[nodiscard]] std::size_t next() const { return next_; }

 private:
  const std::vector<TickInput>* ticks_;
  std::size_t next_;
  std::vector<Estimate>* estimates_;
  bool any_ = false;
};

template <class Scalar>
std::vector<Estimate> run(const std::vector<TickInput>& ticks) {
  std::vector<Estimate> estimates;
  Pages pages;
  TwoSlots slots(pages, 0);
  for (std::size_t begin = 0; begin < ticks.size();) {
    IdentificationTask<Scalar> task;
    static_cast<void>(restore_saved(task, slots));
    Stretch stretch(ticks, begin, estimates);
    SavingHal saving(stretch, task, slots);
    static_cast<void>(run_loop(saving, task));
    begin = stretch.next();
  }
  return estimates;
}

}  // namespace

std::vector<std::optional<Sample>> samples_of(const Record& record) {
  std::vector<std::optional<Sample>> samples;
  ReplayedHal hal(record);
  while (hal.wait_tick() == Status::kOk) {
    Sample sample;
    samples.emplace_back(hal.read_sample(sample) == Status::kOk ? std::optional(sample) : std::nullopt);
  }
  return samples;
}

std::vector<Estimate> in_process(const std::vector<TickInput>& ticks, link::Number number) {
  return number == link::Number::kFixed ? run<Fixed>(ticks) : run<float>(ticks);
}

bool same_bits(const Estimate& a, const Estimate& b) {
  const link::PayloadWriter left = link::payload(a);
  const link::PayloadWriter right = link::payload(b);
  return std::equal(left.bytes().begin(), left.bytes().end(), right.bytes().begin(), right.bytes().end());
}

}  // namespace steerid::hil
