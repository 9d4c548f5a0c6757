# SPDX-License-Identifier: BSD-3-Clause
# The Debian packages: cmake --preset package && cmake --build --preset package && cpack --preset package
set(CRISP_MAINTAINER "The crisp authors <crisp@localhost>" CACHE STRING "Who answers for the packages")

# The name of each component's package, and what it holds.
set(packages
  "program|crisp|calibrates spinning 2D lasers, and makes 3D clouds of them"
  "libraries|libcrisp${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}|libraries of crisp, for 3D clouds from spinning 2D lasers"
  "development|libcrisp-dev|headers and CMake package of crisp's libraries"
  "documentation|crisp-doc|documentation of crisp, for 3D clouds from spinning 2D lasers"
  "python|python3-crisp|Python package of crisp, for 3D clouds from spinning 2D lasers")
set(description
  "Finds from a recording alone when each measurement of n two-dimensional lasers on a spinning plate was taken,\\n"
  " and where each laser sits, and places each beam where the plate was when it was fired.")
string(CONCAT description ${description})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "${CRISP_MAINTAINER}")
set(CPACK_PACKAGE_VENDOR "crisp")
set(CPACK_PACKAGING_INSTALL_PREFIX "${CMAKE_INSTALL_PREFIX}")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                                WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)

# The changelog in the form that Debian's tools read.
set(changelog "${CMAKE_BINARY_DIR}/changelog.Debian")
file(WRITE "${changelog}" "crisp (${PROJECT_VERSION}-1) unstable; urgency=medium\n\n  * See CHANGELOG.md in crisp-doc.\n\n"
     " -- ${CRISP_MAINTAINER}  Fri, 27 Nov 2026 12:00:00 +0000\n")
file(ARCHIVE_CREATE OUTPUT "${changelog}.gz" PATHS "${changelog}" FORMAT raw COMPRESSION GZip COMPRESSION_LEVEL 9
     MTIME "2026-11-27 12:00:00")

foreach(package ${packages})
  string(REGEX REPLACE "\\|.*" "" component "${package}")
  string(REGEX REPLACE "^[^|]*\\|([^|]*)\\|.*" "\\1" name "${package}")
  string(REGEX REPLACE ".*\\|" "" summary "${package}")
  string(TOUPPER "${component}" upper)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME "${name}")
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${description}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION science)
  install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${name}" RENAME copyright
          COMPONENT ${component})
  install(FILES "${changelog}.gz" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${name}" COMPONENT ${component})
endforeach()
set(CPACK_DEBIAN_LIBRARIES_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS libraries)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libpcl-dev, libflann-dev, liblz4-dev, libeigen3-dev, libboost-dev, coinor-libipopt-dev, libceres-dev, libtbb-dev, libhwy-dev, libjemalloc-dev, libyaml-cpp-dev, nlohmann-json3-dev, libfmt-dev, libcli11-dev, libssl-dev, libpcap-dev, libtins-dev, liblzf-dev, libpng-dev, pkg-config")
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy, crisp (= ${PROJECT_VERSION}-1)")

include(CPack)
