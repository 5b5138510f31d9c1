# Installation: the libraries with their headers, for find_package(lobelia) and for pkg-config, the lobelia command, and
# what belongs to them.
#
#   component   CMake target      pkg-config       needs
#   core        lobelia::core     lobelia          Highway
#   bake        lobelia::bake     lobelia-bake     what the tree links: the table below
#   c           lobelia::c        lobelia-c        nothing (a shared library); lobelia::c_static comes with bake
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/lobelia)
set(pkgconfig_folder ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
# The pkg-config files find their prefix from where they lie, so that the tree may be moved.
file(RELATIVE_PATH prefix_from_pkgconfig /prefix/${pkgconfig_folder} /prefix)

set(bake_libraries "")
if(TARGET lobelia_bake)
  set(bake_libraries lobelia_bake lobelia_shade lobelia_trace lobelia_scene lobelia_io)
endif()
set(installed_libraries lobelia_core ${bake_libraries} lobelia_c_static)

# Libraries that only the build needs: compiler flags, and libraries of headers alone.
set(header_libraries Eigen3::Eigen nlohmann_json::nlohmann_json)

# lobelia_dependency(<target> <arguments of find_dependency> <pkg-config module or -l flag>): a library that installed
# ones link.
function(lobelia_dependency target find pkgconfig)
  set(find_${target} "${find}" PARENT_SCOPE)
  set(pkgconfig_${target} "${pkgconfig}" PARENT_SCOPE)
endfunction()
lobelia_dependency(TBB::tbb "TBB" tbb)
lobelia_dependency(OpenEXR::OpenEXR "OpenEXR" OpenEXR)
lobelia_dependency(OpenEXR::IlmImf "OpenEXR" OpenEXR)
lobelia_dependency(ZLIB::ZLIB "ZLIB" zlib)
lobelia_dependency(fmt::fmt "fmt" fmt)
lobelia_dependency(PNG::PNG "PNG" libpng)
lobelia_dependency(JPEG::JPEG "JPEG" libjpeg)
lobelia_dependency(WebP::webp "WebP" libwebp)
lobelia_dependency(embree "embree ${embree_VERSION_MAJOR}" -lembree${embree_VERSION_MAJOR})

# Hides what only the build needs from the installed targets, and collects the others' lines for the package files.
set(find_dependencies "")
set(pkgconfig_requires "")
set(pkgconfig_flags "")
foreach(library IN LISTS bake_libraries)
  get_target_property(links ${library} INTERFACE_LINK_LIBRARIES)
  set(exported "")
  foreach(link IN LISTS links)
    string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" name "${link}")
    if(name MATCHES "^\\$<BUILD_INTERFACE:" OR name IN_LIST installed_libraries)
      list(APPEND exported "${link}")
      continue()
    endif()
    set(type "")
    if(TARGET ${name})
      get_target_property(type ${name} TYPE)
    endif()
    if((name MATCHES "^lobelia_" AND type STREQUAL INTERFACE_LIBRARY) OR name IN_LIST header_libraries)
      list(APPEND exported "$<BUILD_INTERFACE:${link}>")
      continue()
    endif()
    list(APPEND exported "${link}")
    if(name MATCHES "^PkgConfig::(.*)$")
      set(module ${${CMAKE_MATCH_1}_MODULE_NAME})
      list(APPEND find_dependencies "lobelia_find_by_pkgconfig(${CMAKE_MATCH_1} ${module})")
      list(APPEND pkgconfig_requires ${module})
    elseif(DEFINED find_${name})
      list(APPEND find_dependencies "find_dependency(${find_${name}})")
      if(pkgconfig_${name} MATCHES "^-l")
        list(APPEND pkgconfig_flags ${pkgconfig_${name}})
      else()
        list(APPEND pkgconfig_requires ${pkgconfig_${name}})
      endif()
    else()
      message(FATAL_ERROR "${library} links ${name}, which cmake/install.cmake does not know: add a lobelia_dependency, or name it in bake_libraries")
    endif()
  endforeach()
  set_target_properties(${library} PROPERTIES INTERFACE_LINK_LIBRARIES "${exported}")
  # The folder of internal headers is the build's, too.
  get_target_property(folders ${library} INTERFACE_INCLUDE_DIRECTORIES)
  if(folders)
    set_target_properties(${library} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "$<BUILD_INTERFACE:${folders}>")
  endif()
  string(REPLACE "lobelia_" "" export_name ${library})
  set_target_properties(${library} PROPERTIES EXPORT_NAME ${export_name})
endforeach()
list(REMOVE_DUPLICATES find_dependencies)
list(REMOVE_DUPLICATES pkgconfig_requires)
string(REPLACE ";" "\n  " find_dependencies "${find_dependencies}")
string(REPLACE ";" " " pkgconfig_requires "${pkgconfig_requires}")
string(REPLACE ";" " " pkgconfig_flags "${pkgconfig_flags}")

# Libraries and headers.
install(TARGETS lobelia_core EXPORT lobelia_core_targets)
install(EXPORT lobelia_core_targets FILE lobeliaCoreTargets.cmake NAMESPACE lobelia:: DESTINATION ${package_folder})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/lobelia DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
set(pkgconfig_files lobelia)
if(bake_libraries)
  install(TARGETS ${bake_libraries} lobelia_c_static EXPORT lobelia_bake_targets)
  install(EXPORT lobelia_bake_targets FILE lobeliaBakeTargets.cmake NAMESPACE lobelia:: DESTINATION ${package_folder})
  install(TARGETS lobelia_c EXPORT lobelia_c_targets)
  install(EXPORT lobelia_c_targets FILE lobeliaCTargets.cmake NAMESPACE lobelia:: DESTINATION ${package_folder})
  list(APPEND pkgconfig_files lobelia-bake lobelia-c)
endif()
foreach(name IN LISTS pkgconfig_files)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/${name}.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${pkgconfig_folder})
endforeach()
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/lobeliaConfig.cmake.in ${PROJECT_BINARY_DIR}/lobeliaConfig.cmake
  INSTALL_DESTINATION ${package_folder} NO_SET_AND_CHECK_MACRO)
# Before 1.0 a new minor version may break what was.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lobeliaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lobeliaConfig.cmake ${PROJECT_BINARY_DIR}/lobeliaConfigVersion.cmake
  ${CMAKE_CURRENT_LIST_DIR}/highway.cmake
  DESTINATION ${package_folder})

# The command, and the script that lobelia unwrap runs; the script's packages come by npm ci.
if(TARGET lobelia_cli)
  install(TARGETS lobelia_cli)
  install(FILES ${PROJECT_SOURCE_DIR}/tools/unwrap.mjs ${PROJECT_SOURCE_DIR}/tools/package.json
    ${PROJECT_SOURCE_DIR}/tools/package-lock.json DESTINATION ${CMAKE_INSTALL_DATADIR}/lobelia/tools)
endif()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
install(FILES ${PROJECT_SOURCE_DIR}/THIRD_PARTY.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

include(${CMAKE_CURRENT_LIST_DIR}/package.cmake)
