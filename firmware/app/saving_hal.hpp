// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A back end of the port that also keeps the estimate over a reset: it stands between the loop and the board, and saves
// every kSavePeriod ticks, before the tick that follows.
//
//   restore_saved(task, slots);              // before the first tick; kOk when the task goes on from what was kept
//   SavingHal saving(board, task, slots);
//   run_loop(saving, task);
//
// A save is dropped when there is nothing worth keeping (IdentificationTask::save) and when the storage fails: the
// loop goes on, and the next save is 10 s away. The storage must be quick beside a period.
#pragma once

#include <cstdint>

#include "app/saved_state.hpp"
#include "app/task.hpp"
#include "port/port.hpp"

namespace steerid {

/// The statuses of TwoSlots::load and IdentificationTask::restore.
template <class Scalar, SavedStorage Storage>
Status restore_saved(IdentificationTask<Scalar>& task, TwoSlots<Storage>& slots) {
  SavedEstimate saved;
  const Status status = slots.load(saved);
  return status == Status::kOk ? task.restore(saved) : status;
}

template <Hal Board, class Scalar, SavedStorage Storage>
class SavingHal {
 public:
  static constexpr std::uint32_t kSavePeriod = 1000;  ///< ticks, 10 s

  SavingHal(Board& board, IdentificationTask<Scalar>& task, TwoSlots<Storage>& slots)
      : board_(&board), task_(&task), slots_(&slots) {}

  Status wait_tick() {
    if (++ticks_ > kSavePeriod) {
      ticks_ = 1;
      save();
    }
    return board_->wait_tick();
  }
  Status read_sample(Sample& sample) { return board_->read_sample(sample); }
  Status publish(const Estimate& estimate) { return board_->publish(estimate); }
  Status request_probe_torque(std::int32_t torque_mnm) { return board_->request_probe_torque(torque_mnm); }
  void set_valid(bool level) { board_->set_valid(level); }
  void set_fault(bool level) { board_->set_fault(level); }
  void kick_watchdog() { board_->kick_watchdog(); }

 private:
  // A call of its own: the records are not to stay on the loop's stack while it identifies.
  [[gnu::noinline]] void save() {
    SavedEstimate saved;
    if (task_->save(saved) == Status::kOk) static_cast<void>(slots_->save(saved));
  }

  Board* board_;
  IdentificationTask<Scalar>* task_;
  TwoSlots<Storage>* slots_;
  std::uint32_t ticks_ = 0;
};

}  // namespace steerid
