# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# Builds and runs consumer/ in WORK_DIR from nothing. MODE says how it gets at the project.
function(must_run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
if(MODE STREQUAL "find_package")
  # The headers and package files alone: what the tests built around them is not part of what a consumer gets.
  must_run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix --component firmware)
  set(where -D CMAKE_PREFIX_PATH=${WORK_DIR}/prefix)
else()
  set(where -D STEERID_SOURCE_DIR=${SOURCE_DIR})
endif()

must_run(${CMAKE_COMMAND} -S ${CONSUMER_DIR} -B ${WORK_DIR}/build -G Ninja ${where} -D CMAKE_BUILD_TYPE=Release
  -D CMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} -D CMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS})
must_run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
must_run(${WORK_DIR}/build/consumer)
