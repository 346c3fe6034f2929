# Debian packages by `cpack` in the build folder: `isorim` with the program, its manual and cases, `isorim-dev` with the
# libraries, `python3-isorim` with the Python package where it is built. What programs depend on is found by
# dpkg-shlibdeps, what the libraries do is what built them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME isorim)
set(CPACK_PACKAGE_CONTACT "The developers of isorim <developers@isorim.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
if(ISORIM_BUILD_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME isorim)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
    "Reads the boundary of a shape as CAD describes it (NURBS, trimmed faces, T-splines; IGES, STEP)
and computes its geometric properties and integrals by the radial integration method, and
boundary-element solutions on it, without a mesh.")

file(STRINGS ${PROJECT_SOURCE_DIR}/.ci/packages isorim_development_depends REGEX "^build +lib.*-dev$|^build +nlohmann")
list(TRANSFORM isorim_development_depends REPLACE "^build +" "")
list(FILTER isorim_development_depends EXCLUDE REGEX "gtest|gmock|cli11")
list(JOIN isorim_development_depends ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME isorim-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "The libraries of isorim with their headers, for find_package(isorim).")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-isorim)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3, python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/debian/postinst
                                              ${CMAKE_CURRENT_LIST_DIR}/debian/prerm)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "The Python package isorim: boundaries, integrals and solutions as numpy arrays.")
include(CPack)
