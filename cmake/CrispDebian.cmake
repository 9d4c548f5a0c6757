# SPDX-License-Identifier: BSD-3-Clause
# The Debian packages. One command makes them, in build/package: cmake --workflow --preset package
set(CRISP_MAINTAINER "The crisp authors <crisp@localhost>" CACHE STRING "Who answers for the packages")
set(released_in_changelog "Fri, 27 Nov 2026 12:00:00 +0000")
set(debian "${CMAKE_CURRENT_LIST_DIR}/debian")
set(version "${PROJECT_VERSION}-1")
set(libraries "libcrisp${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "${CRISP_MAINTAINER}")
set(CPACK_PACKAGE_VENDOR "crisp")
set(CPACK_PACKAGING_INSTALL_PREFIX "${CMAKE_INSTALL_PREFIX}")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                                WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SOURCE crisp)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Where cpack has put the package of the libraries, which the other packages are linked with.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS
  "${CMAKE_BINARY_DIR}/_CPack_Packages/${CMAKE_SYSTEM_NAME}/DEB/crisp-${PROJECT_VERSION}-${CMAKE_SYSTEM_NAME}/libraries${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}")
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)

# The licence and the changelog in the form that Debian's tools read.
file(READ "${PROJECT_SOURCE_DIR}/LICENSE" licence)
string(REGEX MATCH "Copyright \\(c\\) ([^\n]*)\n\n(.*[^\n])" licence "${licence}")
set(holders "${CMAKE_MATCH_1}")
set(licence "${CMAKE_MATCH_2}")
string(REPLACE "\n\n" "\n.\n" licence "${licence}")
string(REPLACE "\n" "\n " licence "${licence}")
configure_file("${debian}/copyright.in" "${CMAKE_BINARY_DIR}/copyright" @ONLY)
configure_file("${debian}/changelog.in" "${CMAKE_BINARY_DIR}/changelog" @ONLY)

# crisp_compress(<file> <compressed>) as Debian wants it: as small as can be, without a time of its own.
function(crisp_compress file compressed)
  execute_process(COMMAND gzip -9nc "${file}" OUTPUT_FILE "${compressed}" COMMAND_ERROR_IS_FATAL ANY)
endfunction()
crisp_compress("${CMAKE_BINARY_DIR}/changelog" "${CMAKE_BINARY_DIR}/changelog.Debian.gz")
crisp_compress("${PROJECT_SOURCE_DIR}/CHANGELOG.md" "${CMAKE_BINARY_DIR}/changelog.gz")

# crisp_package(<component> <name> <section> <summary>) makes a package of what is installed as a component.
function(crisp_package component name section summary)
  string(TOUPPER "${component}" upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME "${name}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION "${section}" PARENT_SCOPE)
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}
 crisp finds from a recording alone when each measurement of two-dimensional
 lasers on a spinning plate was taken, and where each laser sits. It places
 each beam where the plate was when it was fired, in one 3D point cloud." PARENT_SCOPE)
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
  set(folder "${CMAKE_INSTALL_DATADIR}/doc/${name}")
  install(FILES "${CMAKE_BINARY_DIR}/copyright" "${CMAKE_BINARY_DIR}/changelog.Debian.gz"
                "${CMAKE_BINARY_DIR}/changelog.gz" DESTINATION "${folder}" COMPONENT ${component})
  if(EXISTS "${debian}/${component}.lintian-overrides")
    install(FILES "${debian}/${component}.lintian-overrides" DESTINATION "${CMAKE_INSTALL_DATADIR}/lintian/overrides"
            RENAME "${name}" COMPONENT ${component})
  endif()
endfunction()
crisp_package(program crisp science "3D point clouds from spinning 2D lasers, self-calibrated")
crisp_package(libraries ${libraries} libs "3D point clouds from spinning 2D lasers (libraries)")
crisp_package(development libcrisp-dev libdevel "3D point clouds from spinning 2D lasers (headers)")
crisp_package(documentation crisp-doc doc "3D point clouds from spinning 2D lasers (documentation)")

set(CPACK_DEBIAN_LIBRARIES_PACKAGE_CONTROL_EXTRA "${debian}/libraries/triggers")

# What each needs beside the libraries that it is linked with.
set(CPACK_COMPONENT_PROGRAM_DEPENDS libraries)
set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS libraries)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS crisp-doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SHLIBDEPS OFF)
# What find_package(crisp) looks for (CrispPackages.cmake); tests/package shows that nothing is missing.
string(CONCAT CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "coinor-libipopt-dev, libboost-dev, libbz2-dev, libceres-dev, libcli11-dev, libeigen3-dev, libflann-dev, libfmt-dev, "
  "libhwy-dev, libjemalloc-dev, liblz4-dev, liblzf-dev, libpcap-dev, libpcl-dev, libpng-dev, libsqlite3-dev, libssl-dev, "
  "libtbb-dev, libtins-dev, libyaml-cpp-dev, libzstd-dev, nlohmann-json3-dev, pkg-config, zlib1g-dev")
if(TARGET crisp_python)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  crisp_package(python python3-crisp python "3D point clouds from spinning 2D lasers (Python 3)")
  math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
  set(CPACK_COMPONENT_PYTHON_DEPENDS program libraries)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${debian}/python/postinst;${debian}/python/prerm")
endif()

include(CPack)
