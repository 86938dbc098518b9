// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The ECU on the template board; the same for every board at the end of the link.
#include "app/run_loop.hpp"
#include "app/saving_hal.hpp"
#include "base/fixed.hpp"
#include "ecu/linked_ecu.hpp"
#include "identifier/fixed_in_eigen.hpp"
#include "template_board/board.hpp"

namespace steerid::template_board {

bool Board::receive(std::uint8_t&) { return false; }
bool Board::send(std::span<const std::uint8_t>) { return false; }
bool Board::can_send() const { return false; }
void Board::sleep() {}
void Board::run_timer(bool) {}
std::uint32_t Board::timer_ticks() const { return 0; }
void Board::start_stopwatch() {}
std::uint32_t Board::stopwatch_us() const { return 0; }
void Board::set_lines(bool, bool) {}
void Board::start_watchdog() {}
void Board::kick_watchdog() {}
void Board::reset(bool) {}
link::Identity Board::identity() const { return {}; }
std::uint32_t Board::overflows() const { return Fixed::overflow_count(); }

/// Two pages of flash, EEPROM or backed-up RAM (app/saved_state.hpp).
class Pages {
 public:
  Status read(int, SavedRecord&) { return Status::kIoError; }
  Status write(int, const SavedRecord&) { return Status::kIoError; }
};

// Here and not within a function, where the compiler guards them against a second thread by code that needs exceptions:
// start-up runs their constructors (.init_array).
Board board;
IdentificationTask<Fixed> task;

}  // namespace steerid::template_board

/// From the start-up code.
extern "C" void run_ecu();
void run_ecu() {
  using namespace steerid;
  using namespace steerid::template_board;
  constexpr std::uint32_t kWheel = 0;  // which wheel a saved estimate belongs to
  Pages pages;
  TwoSlots slots(pages, kWheel);
  static_cast<void>(restore_saved(task, slots));
  LinkedEcu ecu(board);
  SavingHal saving(ecu, task, slots);
  static_cast<void>(run_loop(saving, task));
}
