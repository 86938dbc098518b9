# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# What is flashed is headers: two targets that hold all of them to the rules of docs/coding_rules.md.
#   flashed_headers_alone  compiles each by itself, so that it includes all that it uses
#   flashed_headers        one source that includes all: a linter reads Eigen once, not once for each of them
set(flashed base port identifier app can link ecu)
add_custom_target(flashed_headers_alone)
set(includes)
foreach(name ${flashed})
  add_dependencies(flashed_headers_alone steerid_${name}_verify_interface_header_sets)
  set_target_properties(steerid_${name} PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON)
  get_target_property(headers steerid_${name} HEADER_SET)
  foreach(header ${headers})
    string(APPEND includes "#include \"${header}\"\n")
  endforeach()
endforeach()
list(TRANSFORM flashed PREPEND steerid_ OUTPUT_VARIABLE libraries)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/flashed_headers.cpp CONTENT "${includes}" @ONLY)
add_library(flashed_headers OBJECT EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/flashed_headers.cpp)
target_link_libraries(flashed_headers PRIVATE ${libraries})
