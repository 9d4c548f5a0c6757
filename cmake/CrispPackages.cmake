# SPDX-License-Identifier: BSD-3-Clause
# The packages that crisp depends on. A package that only some folders need is required here as well, so that
# configuring fails at once. An installed crisp requires the same ones of its users.

# crisp_require_header(<header> <Debian package>) ends the configuration where a library without a package file of
# CMake's or pkg-config's that serves is missing.
function(crisp_require_header header package)
  string(MAKE_C_IDENTIFIER "CRISP_${header}" found)
  find_path(${found} "${header}")
  mark_as_advanced(${found})
  if(NOT ${found})
    message(FATAL_ERROR "${header} is missing: install ${package}")
  endif()
endfunction()

find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(yaml-cpp REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(TBB REQUIRED)
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(CLI11 REQUIRED)
find_package(flann REQUIRED)  # link crisp_flann: the packaged target forgets lz4
pkg_check_modules(HWY REQUIRED IMPORTED_TARGET libhwy)
pkg_check_modules(IPOPT REQUIRED IMPORTED_TARGET ipopt)
# By pkg-config, since find_package(PCL) drags in far more than crisp needs.
pkg_check_modules(PCL_COMMON REQUIRED IMPORTED_TARGET pcl_common)
pkg_check_modules(LZF REQUIRED IMPORTED_TARGET liblzf)
pkg_check_modules(PCAP REQUIRED IMPORTED_TARGET libpcap)
pkg_check_modules(TINS REQUIRED IMPORTED_TARGET libtins)
find_package(BZip2 REQUIRED)
pkg_check_modules(LZ4 REQUIRED IMPORTED_TARGET liblz4)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(ZLIB REQUIRED IMPORTED_TARGET zlib)
pkg_check_modules(SQLITE REQUIRED IMPORTED_TARGET sqlite3)
pkg_check_modules(JEMALLOC IMPORTED_TARGET jemalloc)  # for speed alone

crisp_require_header(ceres/jet.h libceres-dev)
crisp_require_header(boost/asio/io_context.hpp libboost-dev)
crisp_require_header(boost/math/distributions/chi_squared.hpp libboost-dev)
crisp_require_header(lz4.h liblz4-dev)

add_library(crisp_flann INTERFACE IMPORTED GLOBAL)
target_link_libraries(crisp_flann INTERFACE flann::flann_cpp lz4)
if(NOT TARGET yaml-cpp::yaml-cpp)  # yaml-cpp 0.7
  add_library(yaml-cpp::yaml-cpp ALIAS yaml-cpp)
endif()

if(CRISP_BUILD_TESTS)
  find_package(GTest REQUIRED)
  find_library(CRISP_PCL_IO pcl_io REQUIRED)  # with its VTK, only where tests hold crisp's PCD files against PCL
  include(GoogleTest)
endif()
if(CRISP_BUILD_BENCHMARKS)
  find_package(benchmark REQUIRED)
  find_package(nanoflann REQUIRED)  # a competitor, as the next
  pkg_check_modules(PCL_KDTREE REQUIRED IMPORTED_TARGET pcl_kdtree)
endif()
