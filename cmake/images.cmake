# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# The microcontroller images beside the host build: build/firmware/steerid-an386.elf and steerid-an385.elf. Each is a
# build of its own with its own compiler, kept up to date by the target `images`.
include(ExternalProject)
find_program(STEERID_ARM_COMPILER arm-none-eabi-g++)
if(NOT STEERID_ARM_COMPILER)
  message(STATUS "arm-none-eabi-g++ is not installed: no microcontroller images")
  return()
endif()

function(steerid_image BOARD)
  string(REPLACE "mps2_" "steerid-" image ${BOARD})
  ExternalProject_Add(image_${BOARD}
    SOURCE_DIR ${PROJECT_SOURCE_DIR}
    BINARY_DIR ${PROJECT_BINARY_DIR}/images/${BOARD}
    CMAKE_ARGS
      -DCMAKE_TOOLCHAIN_FILE=${PROJECT_SOURCE_DIR}/cmake/arm-none-eabi.cmake -DCMAKE_BUILD_TYPE=Release
      -DSTEERID_BOARD=${BOARD} -DSTEERID_HOST=OFF -DSTEERID_TESTS=OFF -DSTEERID_INSTALL=OFF
      -DEigen3_DIR=${Eigen3_DIR} -DCMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER}
    BUILD_ALWAYS ON
    BUILD_BYPRODUCTS ${PROJECT_BINARY_DIR}/firmware/${image}.elf
    INSTALL_COMMAND ${CMAKE_COMMAND} -E copy_if_different <BINARY_DIR>/${image}.elf
      ${PROJECT_BINARY_DIR}/firmware/${image}.elf)
endfunction()

steerid_image(mps2_an386)
steerid_image(mps2_an385)
add_custom_target(images ALL DEPENDS image_mps2_an386 image_mps2_an385)
