# SPDX-License-Identifier: BSD-3-Clause
# Precompiled headers. The headers from outside the project that most sources include are parsed once for the libraries
# and once for the tests. Without them (presets dev, asan and tidy) a source that forgets an include does not compile.
option(CRISP_PRECOMPILE "Precompile the headers that most sources include" ON)

# crisp_precompile(<target> <library|test>) makes a target use the precompiled headers of that kind.
function(crisp_precompile target kind)
  if(CRISP_PRECOMPILE)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:crisp_${kind}_precompiled>)
    target_precompile_headers(${target} REUSE_FROM crisp_${kind}_headers)
  endif()
endfunction()

if(NOT CRISP_PRECOMPILE)
  return()
endif()

set(headers <algorithm> <array> <charconv> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits> <map> <memory>
            <numbers> <numeric> <optional> <random> <set> <span> <sstream> <string> <string_view> <utility> <vector>
            <Eigen/Core> <fmt/format.h>)
# What the headers need, so that each user of them has the same definitions.
add_library(crisp_library_precompiled INTERFACE)
target_link_libraries(crisp_library_precompiled INTERFACE Eigen3::Eigen fmt::fmt)
target_compile_options(crisp_library_precompiled INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)  # for ccache

set(empty "${CMAKE_BINARY_DIR}/precompiled.cpp")
file(CONFIGURE OUTPUT "${empty}" CONTENT "int main() {}\n")
add_library(crisp_library_headers STATIC "${empty}")
target_link_libraries(crisp_library_headers PRIVATE crisp_library_precompiled crisp_settings)
target_precompile_headers(crisp_library_headers PRIVATE ${headers})
if(CRISP_BUILD_TESTS)
  add_library(crisp_test_precompiled INTERFACE)
  target_link_libraries(crisp_test_precompiled INTERFACE crisp_library_precompiled GTest::gmock)
  add_executable(crisp_test_headers "${empty}")  # position-independent as programs are, not as libraries are
  target_link_libraries(crisp_test_headers PRIVATE crisp_test_precompiled crisp_test_settings)
  target_precompile_headers(crisp_test_headers PRIVATE ${headers} <gmock/gmock.h> <gtest/gtest.h>)
endif()
