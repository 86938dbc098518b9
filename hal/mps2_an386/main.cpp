// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The ECU: the 100 Hz task on an MPS2 board, in float on the Cortex-M4F, in fixed point on the Cortex-M3.
#include "app/run_loop.hpp"
#include "app/saving_hal.hpp"
#include "base/fixed.hpp"
#include "ecu/linked_ecu.hpp"
#include "identifier/fixed_in_eigen.hpp"
#include "mps2_an386/board.hpp"
#include "mps2_an386/kept_memory.hpp"

namespace steerid::mps2 {
namespace {

#ifdef __ARM_FP
using Number = float;
constexpr auto kBoard = link::Board::kMps2An386;
constexpr auto kNumber = link::Number::kFloat;
std::uint32_t overflows() { return 0; }
#else
using Number = Fixed;
constexpr auto kBoard = link::Board::kMps2An385;
constexpr auto kNumber = link::Number::kFixed;
std::uint32_t overflows() { return Fixed::overflow_count(); }
#endif

constexpr std::uint32_t kWheel = 0x57454552U;  ///< which wheel the saved estimate belongs to; the integrator's choice

// Apart from the loop, whose frame stays on the stack for good: what starting takes is given back.
[[gnu::noinline]] IdentificationTask<Number>& new_task() {
  static IdentificationTask<Number> task;
  return task;
}
[[gnu::noinline]] bool restored(IdentificationTask<Number>& task, TwoSlots<KeptPages>& slots) {
  return restore_saved(task, slots) == Status::kOk;
}

}  // namespace
}  // namespace steerid::mps2

/// Never returns on a board: run_loop ends with its stream only.
extern "C" void run_ecu();
void run_ecu() {
  using namespace steerid;
  static mps2::Board board(mps2::kBoard, mps2::kNumber, mps2::overflows);
  IdentificationTask<mps2::Number>& task = mps2::new_task();
  mps2::KeptPages pages;
  TwoSlots slots(pages, mps2::kWheel);
  board.restored(mps2::restored(task, slots));
  static LinkedEcu ecu(board);
  SavingHal saving(ecu, task, slots);
  static_cast<void>(run_loop(saving, task));
}
