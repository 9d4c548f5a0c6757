# SPDX-License-Identifier: BSD-3-Clause
# What find_package(crisp) finds: the targets crisp::data, crisp::stage …, each made by crisp_library(), and
# crisp_add_plugin().
include(CMakePackageConfigHelpers)

set(package "${CMAKE_INSTALL_LIBDIR}/cmake/crisp")
configure_package_config_file(cmake/crispConfig.cmake.in "${CMAKE_BINARY_DIR}/crispConfig.cmake"
                              INSTALL_DESTINATION "${package}")
write_basic_package_version_file("${CMAKE_BINARY_DIR}/crispConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(EXPORT crispTargets NAMESPACE crisp:: DESTINATION "${package}" COMPONENT development)
install(DIRECTORY pipeline/include/crisp DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT development)
install(FILES "${CMAKE_BINARY_DIR}/crispConfig.cmake" "${CMAKE_BINARY_DIR}/crispConfigVersion.cmake"
              cmake/CrispPackages.cmake cmake/CrispPlugin.cmake DESTINATION "${package}" COMPONENT development)
install(DIRECTORY configs/ DESTINATION "${CMAKE_INSTALL_DATADIR}/crisp/configs" COMPONENT program)
install(FILES README.md CONTRIBUTING.md DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT documentation)
if(NOT CRISP_DEBIAN)  # which has them in Debian's form
  install(FILES LICENSE CHANGELOG.md DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT documentation)
endif()
install(DIRECTORY docs DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT documentation)
# Where the pages' links lead.
install(DIRECTORY configs DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT documentation)
install(DIRECTORY tests/examples DESTINATION "${CMAKE_INSTALL_DOCDIR}/tests" COMPONENT documentation)
