# A Debian package, lobelia_<version>_<architecture>.deb:
#
#   cmake --preset package && cmake --build --preset package && (cd build/package && cpack)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME lobelia)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_VENDOR "The Lobelia authors")
# Without an address: the project has none; reports go to its repository.
set(CPACK_PACKAGE_CONTACT "The Lobelia authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "bakes light into lobes: lightmaps and probes in small directional bases")
set(CPACK_PACKAGE_DESCRIPTION "Lobelia bakes lightmaps and light probes of glTF scenes by path tracing and encodes\
 radiance on the fly in spherical Gaussians, spherical harmonics and their relatives. It evaluates, stores and measures\
 them, too. The package holds the command, the C++ libraries with their headers, and the C interface.")
set(CPACK_PACKAGE_INSTALL_DIRECTORY lobelia)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# lobelia unwrap runs under Node.js; building against the libraries takes their headers.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "nodejs (>= 18), npm")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
  "libhwy-dev, libembree-dev, libtbb-dev, libopenexr-dev, libfmt-dev, zlib1g-dev, pkg-config")
if(TARGET lobelia_python)
  # The extension module is for one version of Python.
  set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3 (>= ${lobelia_python_version}), python3-numpy")
endif()
include(CPack)
