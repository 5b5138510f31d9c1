# What `cmake --install` gives: the core library with its headers, for find_package(lobelia) and for pkg-config, and the
# lobelia command.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS lobelia_core EXPORT lobelia_targets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/lobelia DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TARGET lobelia_cli)
  install(TARGETS lobelia_cli)
  # What lobelia unwrap runs; its packages come by npm ci.
  install(FILES ${PROJECT_SOURCE_DIR}/tools/unwrap.mjs ${PROJECT_SOURCE_DIR}/tools/package.json
    ${PROJECT_SOURCE_DIR}/tools/package-lock.json DESTINATION ${CMAKE_INSTALL_DATADIR}/lobelia/tools)
endif()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/lobelia)
install(EXPORT lobelia_targets FILE lobeliaTargets.cmake NAMESPACE lobelia:: DESTINATION ${package_folder})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/lobeliaConfig.cmake.in ${PROJECT_BINARY_DIR}/lobeliaConfig.cmake
  INSTALL_DESTINATION ${package_folder} NO_SET_AND_CHECK_MACRO)
# Before 1.0 a new minor version may break what was.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lobeliaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lobeliaConfig.cmake ${PROJECT_BINARY_DIR}/lobeliaConfigVersion.cmake
  ${CMAKE_CURRENT_LIST_DIR}/highway.cmake
  DESTINATION ${package_folder})

# The pkg-config file finds its prefix from where it lies, so that the tree may be moved.
file(RELATIVE_PATH prefix_from_pkgconfig /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
configure_file(${CMAKE_CURRENT_LIST_DIR}/lobelia.pc.in ${PROJECT_BINARY_DIR}/lobelia.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/lobelia.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
