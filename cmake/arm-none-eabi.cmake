# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# Bare-metal Arm Cortex-M by GNU tools. STEERID_BOARD picks the processor.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_ASM_COMPILER arm-none-eabi-gcc)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)  # an executable needs the board's linker script
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES STEERID_BOARD)

if(STEERID_BOARD STREQUAL "mps2_an386")
  set(processor "-mcpu=cortex-m4 -mfpu=fpv4-sp-d16 -mfloat-abi=hard")
elseif(STEERID_BOARD MATCHES "^(mps2_an385|template_board)$")
  # One instruction after the other: moving them apart gains nothing there, and costs registers.
  set(processor "-mcpu=cortex-m3 -mfloat-abi=soft -fno-schedule-insns")
else()
  message(FATAL_ERROR "STEERID_BOARD must be mps2_an386, mps2_an385 or template_board")
endif()
# Blocks stay in the order of the source: to lay the likely ones behind each other gcc copies ends of others and branches
# round them, 0.8 % of the flash on the Cortex-M4F and 1.1 on the Cortex-M3 for half a percent of the instructions on the
# one and none on the other.
set(CMAKE_CXX_FLAGS_INIT
  "${processor} -mthumb -fno-exceptions -fno-rtti -fno-threadsafe-statics -fno-use-cxa-atexit -ffunction-sections -fdata-sections -fno-asynchronous-unwind-tables -fno-reorder-blocks")
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG" CACHE STRING "")  # CMake's own is -O3
