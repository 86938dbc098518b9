# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# One way to declare a library, so that every one of them has the same language level, the same
# floating-point rules and the same warnings, and so that a folder's CMakeLists.txt shows its arrows only.

set(STEERID_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wdouble-promotion -Wnon-virtual-dtor -Werror)

# Applies the project's rules to TARGET; SCOPE is PRIVATE for compiled targets and INTERFACE for header-only ones.
function(steerid_rules TARGET SCOPE)
  target_compile_features(${TARGET} ${SCOPE} cxx_std_20)
  # Fused multiply-add rounds once where two operations round twice: with it the same record would give
  # different bits on x86 and on Cortex-M4F.
  target_compile_options(${TARGET} ${SCOPE} -ffp-contract=off)
  if(NOT SCOPE STREQUAL "INTERFACE")
    target_compile_options(${TARGET} PRIVATE ${STEERID_WARNINGS})
  endif()
endfunction()

# steerid_library(NAME ROOT dir [SOURCES ...] [USES ...])
#   NAME becomes the target steerid_NAME with the alias steerid::NAME. Its headers are those of ROOT/NAME.
#   ROOT is the folder that #include paths start from (firmware, hal or host_sim).
#   USES lists what it may include: the arrows of the architecture, checked by tests/structure.
function(steerid_library NAME)
  cmake_parse_arguments(ARG "" "ROOT" "SOURCES;USES" ${ARGN})
  set(target steerid_${NAME})
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES})
    set(scope PUBLIC)
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(steerid::${NAME} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${NAME})
  steerid_rules(${target} ${scope})
  set(root ${PROJECT_SOURCE_DIR}/${ARG_ROOT})
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${root}/${NAME}/*.hpp)
  target_sources(${target} ${scope} FILE_SET HEADERS BASE_DIRS ${root} FILES ${headers})
  target_link_libraries(${target} ${scope} ${ARG_USES})
endfunction()
