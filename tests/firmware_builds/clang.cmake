# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# The same with clang, which has neither headers nor libraries for Arm of its own: those of the GNU tools serve.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_CXX_COMPILER clang++)
set(CMAKE_CXX_COMPILER_TARGET thumbv7em-none-eabihf)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(processor "-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard")
set(headers "")
execute_process(COMMAND arm-none-eabi-g++ -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard -xc++ -E -v /dev/null
  OUTPUT_QUIET ERROR_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE ".*#include <...> search starts here:\n(.*)End of search list.*" "\\1" said "${said}")
string(REGEX MATCHALL "/[^\n]+" folders "${said}")
foreach(folder IN LISTS folders)
  if(NOT folder MATCHES "/lib/gcc/arm-none-eabi/[0-9.]+/include(-fixed)?$")  # the compiler's own, of which clang has its own
    string(APPEND headers " -isystem ${folder}")
  endif()
endforeach()
set(CMAKE_CXX_FLAGS_INIT "${processor} -nostdlibinc${headers}")
set(CMAKE_CXX_LINK_EXECUTABLE
  "arm-none-eabi-g++ ${processor} <CMAKE_CXX_LINK_FLAGS> <LINK_FLAGS> <OBJECTS> -o <TARGET> <LINK_LIBRARIES>")
