# What a firmware takes from this project: the identifier, the 100 Hz task and the port, all header-only, so that
# `find_package(steerid)` gives steerid::base, steerid::identifier, steerid::port and steerid::app.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/steerid)

install(TARGETS steerid_base steerid_identifier steerid_port steerid_app EXPORT steerid
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/steerid COMPONENT firmware)
install(EXPORT steerid NAMESPACE steerid:: FILE steerid-targets.cmake DESTINATION ${package_dir}
  COMPONENT firmware)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/steerid-config.cmake.in
  ${PROJECT_BINARY_DIR}/steerid-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/steerid-config-version.cmake
  COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${PROJECT_BINARY_DIR}/steerid-config.cmake ${PROJECT_BINARY_DIR}/steerid-config-version.cmake
  DESTINATION ${package_dir} COMPONENT firmware)

if(STEERID_HOST)
  install(TARGETS steerid RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT host)
endif()
if(STEERID_LINUX_ECU)
  install(TARGETS steerid-ecu RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT linux_ecu)
  set(system ${PROJECT_SOURCE_DIR}/hal/linux_ecu/system)
  install(FILES ${system}/steerid-ecu.service DESTINATION lib/systemd/system COMPONENT linux_ecu)
  install(FILES ${system}/60-steerid-gpio.rules DESTINATION lib/udev/rules.d COMPONENT linux_ecu)
  install(FILES ${system}/steerid-ecu.json DESTINATION share/doc/steerid COMPONENT linux_ecu)
endif()
