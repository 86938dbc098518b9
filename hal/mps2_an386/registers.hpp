// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The registers of Arm's MPS2 FPGA images AN385 (Cortex-M3) and AN386 (Cortex-M4F) that this board support uses.
// Arm DAI 0385 and DAI 0386; CMSDK peripherals: Arm DDI 0479; system control: Armv7-M Architecture Reference Manual.
#pragma once

#include <cstdint>

namespace steerid::mps2 {

inline constexpr std::uint32_t kClockHz = 25'000'000;

struct Uart {
  volatile std::uint32_t data;
  volatile std::uint32_t state;      ///< 1 send buffer full, 2 receive buffer full, overruns in 4 and 8
  volatile std::uint32_t control;    ///< 1 send, 2 receive, 4 and 8 their interrupts
  volatile std::uint32_t interrupt;  ///< 1 send, 2 receive; write to clear
  volatile std::uint32_t baud_divider;
};
inline constexpr std::uint32_t kUartSendFull = 1U << 0U;
inline constexpr std::uint32_t kUartReceiveFull = 1U << 1U;
inline constexpr std::uint32_t kUartSends = 1U << 0U;
inline constexpr std::uint32_t kUartReceives = 1U << 1U;
inline constexpr std::uint32_t kUartSendInterrupt = 1U << 2U;
inline constexpr std::uint32_t kUartReceiveInterrupt = 1U << 3U;

struct Watchdog {
  volatile std::uint32_t load;
  volatile std::uint32_t value;
  volatile std::uint32_t control;  ///< 1 counts and interrupts, 2 resets at the second time-out
  volatile std::uint32_t clear;
};

struct Gpio {
  volatile std::uint32_t data;
  volatile std::uint32_t out;
  volatile std::uint32_t reserved[2];
  volatile std::uint32_t out_enable_set;
};

struct SysTick {
  volatile std::uint32_t control;  ///< 1 counts, 2 interrupts, 4 processor clock
  volatile std::uint32_t load;
  volatile std::uint32_t value;
};

inline Uart& uart0() { return *reinterpret_cast<Uart*>(0x40004000U); }
inline Watchdog& watchdog() { return *reinterpret_cast<Watchdog*>(0x40008000U); }
inline Gpio& gpio0() { return *reinterpret_cast<Gpio*>(0x40010000U); }
/// The two LEDs of the FPGA's own register block, bits 0 and 1.
inline volatile std::uint32_t& leds() { return *reinterpret_cast<volatile std::uint32_t*>(0x40028000U); }
inline SysTick& systick() { return *reinterpret_cast<SysTick*>(0xE000E010U); }
inline volatile std::uint32_t& nvic_enable() { return *reinterpret_cast<volatile std::uint32_t*>(0xE000E100U); }
inline volatile std::uint32_t& nvic_pending() { return *reinterpret_cast<volatile std::uint32_t*>(0xE000E200U); }
inline volatile std::uint32_t& coprocessors() { return *reinterpret_cast<volatile std::uint32_t*>(0xE000ED88U); }
inline volatile std::uint32_t& reset_control() { return *reinterpret_cast<volatile std::uint32_t*>(0xE000ED0CU); }

inline constexpr unsigned kUart0ReceiveLine = 0;
inline constexpr unsigned kUart0SendLine = 1;

}  // namespace steerid::mps2
