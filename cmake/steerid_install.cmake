# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# What is installed, as components: `firmware` (what a firmware takes from this project, all of it headers, so that
# `find_package(steerid)` gives steerid::app, steerid::ecu and the others), `host` (the steerid command) and `linux_ecu`
# (the daemon). Each brings licence and documents.
include(CMakePackageConfigHelpers)

set(components firmware)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/steerid)

install(TARGETS steerid_base steerid_identifier steerid_port steerid_app steerid_link steerid_ecu steerid_can
  EXPORT steerid FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/steerid COMPONENT firmware)
install(EXPORT steerid NAMESPACE steerid:: FILE steerid-targets.cmake DESTINATION ${package_dir}
  COMPONENT firmware)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/steerid-config.cmake.in
  ${PROJECT_BINARY_DIR}/steerid-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/steerid-config-version.cmake
  COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${PROJECT_BINARY_DIR}/steerid-config.cmake ${PROJECT_BINARY_DIR}/steerid-config-version.cmake
  DESTINATION ${package_dir} COMPONENT firmware)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/hal/template_board DESTINATION ${CMAKE_INSTALL_DATADIR}/steerid
  COMPONENT firmware)

if(STEERID_HOST)
  list(APPEND components host)
  install(TARGETS steerid RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT host)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/scripts/fleet DESTINATION ${CMAKE_INSTALL_DATADIR}/steerid
    USE_SOURCE_PERMISSIONS COMPONENT host)
  # Manual page and completion are made by the command from its own options.
  install(CODE "
    set(place \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}\")
    file(MAKE_DIRECTORY \"\${place}/${CMAKE_INSTALL_MANDIR}/man1\"
      \"\${place}/${CMAKE_INSTALL_DATADIR}/bash-completion/completions\")
    execute_process(COMMAND \"\${place}/${CMAKE_INSTALL_BINDIR}/steerid\" manual
      --out \"\${place}/${CMAKE_INSTALL_MANDIR}/man1/steerid.1\" COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND \"\${place}/${CMAKE_INSTALL_BINDIR}/steerid\" completion
      --out \"\${place}/${CMAKE_INSTALL_DATADIR}/bash-completion/completions/steerid\" COMMAND_ERROR_IS_FATAL ANY)"
    COMPONENT host)
endif()
if(STEERID_LINUX_ECU)
  list(APPEND components linux_ecu)
  install(TARGETS steerid-ecu RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT linux_ecu)
  set(system ${PROJECT_SOURCE_DIR}/hal/linux_ecu/system)
  install(FILES ${system}/60-steerid-gpio.rules DESTINATION lib/udev/rules.d COMPONENT linux_ecu)
  install(FILES ${system}/steerid-ecu.json DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT linux_ecu)
  install(FILES ${system}/steerid-ecu.service DESTINATION lib/systemd/system COMPONENT linux_ecu)
  # The unit names the daemon where it is installed, which is known by now only.
  install(CODE "
    set(unit \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/lib/systemd/system/steerid-ecu.service\")
    file(READ \"\${unit}\" text)
    string(REPLACE /usr/bin/ \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}/\" text \"\${text}\")
    file(WRITE \"\${unit}\" \"\${text}\")" COMPONENT linux_ecu)
endif()

# With each component the documents, and the files that they refer to at the same places beside them.
foreach(component IN LISTS components)
  foreach(file LICENSE NOTICE README.md CHANGELOG.md CONTRIBUTING.md hal/can/steerid.dbc
      hal/linux_ecu/system/steerid-ecu.json)
    cmake_path(GET file PARENT_PATH folder)
    install(FILES ${PROJECT_SOURCE_DIR}/${file} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder} COMPONENT ${component})
  endforeach()
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT ${component})
endforeach()
