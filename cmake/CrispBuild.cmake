# SPDX-License-Identifier: BSD-3-Clause
# How crisp is compiled, written once: every folder is one target made by crisp_library().

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_CXX_VISIBILITY_PRESET default)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}")

if(PROJECT_IS_TOP_LEVEL AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(CRISP_CCACHE ccache)
  if(CRISP_CCACHE)  # what it holds serves any checkout
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env "CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}" CCACHE_NOHASHDIR=1
                                    CCACHE_SLOPPINESS=pch_defines,time_macros "${CRISP_CCACHE}")
    add_compile_options("-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=")
  endif()
endif()

option(CRISP_WARNINGS_AS_ERRORS "Treat warnings as errors" ON)
set(CRISP_SANITIZE "" CACHE STRING "Sanitizers to build with, as for -fsanitize (address,undefined or thread)")

add_library(crisp_settings INTERFACE)
target_compile_options(crisp_settings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wimplicit-fallthrough
  -Wno-missing-field-initializers  # designated initialisers leave the rest to the defaults
  # Optimising, GCC 12 sees overlaps and overruns in std::string and std::vector where there are none (its bugs
  # 105651 and 107852); the sanitizers see those that are.
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict;-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread>
  $<$<CXX_COMPILER_ID:Clang>:-Wno-gnu-anonymous-struct -Wno-nested-anon-types>  # PCL's macro for x, y, z
  # Where many sources are compiled as one, to be fast, they see each other's names. The preset dev
  # compiles each alone.
  $<$<BOOL:${CMAKE_UNITY_BUILD}>:-Wno-shadow>
  $<$<AND:$<BOOL:${CMAKE_UNITY_BUILD}>,$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>
  $<$<BOOL:${CRISP_WARNINGS_AS_ERRORS}>:-Werror>)
# Tests are compiled for a short build, not for speed: what they measure is in the libraries.
add_library(crisp_test_settings INTERFACE)
target_link_libraries(crisp_test_settings INTERFACE crisp_settings)
target_compile_options(crisp_test_settings INTERFACE $<$<CONFIG:Release>:-O1>)

if(CRISP_SANITIZE)
  add_compile_options(-fsanitize=${CRISP_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${CRISP_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options(-Wno-maybe-uninitialized)  # which g++ reports falsely in instrumented code, as its manual says
  endif()
  if(CRISP_SANITIZE MATCHES "address.*undefined")
    # A tenth to a fifth of the time to compile, for what the address sanitizer sees itself.
    add_compile_options(-fno-sanitize=null,object-size)
    # What tests test is instrumented; they are not, nor optimised, so that they compile in a quarter of the time.
    # Libraries keep their own, instrumented, copies of inline functions. (Objects of the release build would be of
    # another compiler, which gives the empty members of JSON's maps another size.)
    target_compile_options(crisp_test_settings INTERFACE -fno-sanitize=all -O0)
    add_link_options(-Wl,-Bsymbolic-functions)
  endif()
  if(CRISP_SANITIZE STREQUAL "thread")
    # The thread sanitizer does not know fences; Asio's accompany its mutexes, which it knows.
    add_compile_definitions(BOOST_ASIO_DISABLE_FENCED_BLOCK)
  endif()
endif()

# Programs and libraries find each other wherever the whole is put.
file(RELATIVE_PATH CRISP_LIB_FROM_BIN "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_LIBDIR}")
set(CMAKE_INSTALL_RPATH "$ORIGIN" "$ORIGIN/${CRISP_LIB_FROM_BIN}")

# All that `cmake --install` installs, and nothing else: no tests.
add_custom_target(crisp_installed)

# crisp_library(<folder's name> [SHARED|STATIC|INTERFACE] [SOURCES ...] [PUBLIC ...] [PRIVATE ...])
# makes the target crisp_<name> with the alias crisp::<name>, and installs it. The public headers are in
# pipeline/include: <crisp/scan.hpp>, here and in an installed package alike. Headers in the folders are internal, not
# installed, and included from the top of the tree: "pipeline/model/chain.hpp".
function(crisp_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "SHARED;STATIC;INTERFACE" "" "SOURCES;PUBLIC;PRIVATE")
  set(target crisp_${name})
  set(public PUBLIC)
  if(arg_INTERFACE)
    add_library(${target} INTERFACE)
    set(public INTERFACE)
  elseif(arg_SHARED)
    add_library(${target} SHARED ${arg_SOURCES})
  else()
    add_library(${target} STATIC ${arg_SOURCES})
  endif()
  add_library(crisp::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} VERSION ${PROJECT_VERSION}
                        SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_include_directories(${target} ${public}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/pipeline/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} ${public} cxx_std_20)
  target_link_libraries(${target} ${public} ${arg_PUBLIC})
  if(NOT arg_INTERFACE)
    target_link_libraries(${target} PRIVATE ${arg_PRIVATE} $<BUILD_INTERFACE:crisp_settings>)
    crisp_precompile(${target} library)
    add_dependencies(crisp_installed ${target})
  endif()

  install(TARGETS ${target} EXPORT crispTargets
          LIBRARY COMPONENT libraries NAMELINK_COMPONENT development
          ARCHIVE COMPONENT development)
endfunction()

# crisp_test(<name> [THREADS] [REPEATS <filter>] [SLOW <filter>] [SMOKE <filter>] [LONG <filter>] [CLUSTER <filter>]
#            [PROGRAMS <definition>=<target> ...] SOURCES ... LIBRARIES ...)
# makes one GoogleTest program of a folder's tests, with the paths of PROGRAMS (or plugins) as definitions. Filters
# are GoogleTest's. Its quick tests are one test of CTest's, by the program's name; those that a filter calls slow,
# smoke (slow, but run by `./check`: one of each kind), long or cluster (slow, and in need of a scheduler's packages)
# are one each, with that label. Only the release build runs those, and of the quick ones REPEATS: with a sanitizer
# they take long, and other tests run the same code. With THREADS the thread sanitizer runs the quick tests, too
# (target threaded_tests, label threads).
function(crisp_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "THREADS" "REPEATS;SLOW;SMOKE;LONG;CLUSTER" "PROGRAMS;SOURCES;LIBRARIES")
  set(only_slow FALSE)
  if(arg_SLOW STREQUAL "*" OR arg_CLUSTER STREQUAL "*")
    set(only_slow TRUE)
  endif()
  if(only_slow AND CRISP_SANITIZE)
    return()
  endif()
  add_executable(${name}_test ${arg_SOURCES})
  foreach(program ${arg_PROGRAMS})
    string(REPLACE "=" ";" program "${program}")
    list(GET program 0 definition)
    list(GET program 1 target)
    target_compile_definitions(${name}_test PRIVATE ${definition}="$<TARGET_FILE:${target}>")
    add_dependencies(${name}_test ${target})
  endforeach()
  target_link_libraries(${name}_test PRIVATE ${arg_LIBRARIES} crisp_source_dir GTest::gmock GTest::gtest_main
                                             crisp_test_settings)
  crisp_precompile(${name}_test test)
  set_target_properties(${name}_test PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/tests")
  add_dependencies(all_tests ${name}_test)
  if(NOT only_slow)
    set(left_out "${arg_SLOW}:${arg_LONG}:${arg_CLUSTER}")
    if(CRISP_SANITIZE)
      string(APPEND left_out ":${arg_REPEATS}")
    endif()
    add_test(NAME ${name} COMMAND ${name}_test "--gtest_filter=-${left_out}")
    set_tests_properties(${name} PROPERTIES TIMEOUT 1800)
  endif()
  if(arg_THREADS)
    add_dependencies(threaded_tests ${name}_test)
    set_tests_properties(${name} PROPERTIES LABELS threads)
  endif()
  if(arg_SMOKE)
    crisp_discover(${name}_test "${arg_SMOKE}" smoke)
  endif()
  if(arg_SLOW)
    crisp_discover(${name}_test "${arg_SLOW}-${arg_SMOKE}:${arg_LONG}:${arg_CLUSTER}" slow)
  endif()
  if(arg_LONG)
    crisp_discover(${name}_test "${arg_LONG}" long)
  endif()
  if(arg_CLUSTER)
    crisp_discover(${name}_test "${arg_CLUSTER}" cluster)
  endif()
endfunction()

# crisp_discover(<target> <filter> <label>) makes one test of each of a program's that a filter of GoogleTest's lets
# through.
function(crisp_discover target filter label)
  gtest_discover_tests(${target} DISCOVERY_MODE PRE_TEST TEST_FILTER "${filter}"
                       PROPERTIES LABELS ${label} TIMEOUT 1200)
endfunction()

# crisp_fuzz(<name> SOURCES ... LIBRARIES ...) makes one fuzz target, <name>_fuzz, of sources that define
# LLVMFuzzerTestOneInput, with the seeds in corpus/<name>/. With clang and CRISP_BUILD_FUZZERS libFuzzer
# searches from the seeds for CRISP_FUZZ_SECONDS (test fuzz.<name>), with SLOW for twice as long; elsewhere each
# seed is replayed once (test seeds.<name>), so that what was once found stays found in every build.
function(crisp_fuzz name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "SLOW" "" "SOURCES;LIBRARIES")
  set(seeds "${CMAKE_CURRENT_SOURCE_DIR}/corpus/${name}")
  if(NOT IS_DIRECTORY "${seeds}")
    message(FATAL_ERROR "the fuzz target ${name} has no seeds: put some small inputs into ${seeds}")
  endif()
  add_executable(${name}_fuzz ${arg_SOURCES})
  target_link_libraries(${name}_fuzz PRIVATE ${arg_LIBRARIES})
  set_target_properties(${name}_fuzz PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/tests")
  add_dependencies(all_tests ${name}_fuzz)
  if(CRISP_BUILD_FUZZERS)
    target_link_libraries(${name}_fuzz PRIVATE crisp_settings)  # instrumented, unlike tests
    target_link_options(${name}_fuzz PRIVATE -fsanitize=fuzzer)
    foreach(library ${name}_fuzz ${arg_LIBRARIES})  # what reports its coverage
      get_target_property(aliased ${library} ALIASED_TARGET)
      if(aliased)
        set(library ${aliased})
      endif()
      target_compile_options(${library} PRIVATE -fsanitize=fuzzer-no-link)
    endforeach()
    set(found "${CMAKE_BINARY_DIR}/fuzz/${name}")
    file(MAKE_DIRECTORY "${found}/corpus")
    set(seconds "${CRISP_FUZZ_SECONDS}")
    if(arg_SLOW)
      math(EXPR seconds "2 * ${seconds}")
    endif()
    add_test(NAME fuzz.${name} COMMAND ${name}_fuzz -max_total_time=${seconds} -timeout=10
             -rss_limit_mb=2048 -print_final_stats=1 -artifact_prefix=${found}/ ${found}/corpus ${seeds})
    math(EXPR limit "${seconds} + 300")
    set_tests_properties(fuzz.${name} PROPERTIES LABELS fuzz TIMEOUT ${limit})
  else()
    target_link_libraries(${name}_fuzz PRIVATE crisp_replay crisp_test_settings)
    crisp_precompile(${name}_fuzz test)
    add_test(NAME seeds.${name} COMMAND ${name}_fuzz ${seeds})
    set_tests_properties(seeds.${name} PROPERTIES TIMEOUT 120)
  endif()
endfunction()

# crisp_benchmark(<name> SOURCES ... LIBRARIES ...) makes one Google Benchmark program, <name>_bench.
# Benchmarks are no tests: nothing fails for being slow. Their memory comes from where the program's does.
function(crisp_benchmark name)
  if(NOT CRISP_BUILD_BENCHMARKS)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;LIBRARIES")
  add_executable(${name}_bench ${arg_SOURCES})
  target_link_libraries(${name}_bench PRIVATE ${arg_LIBRARIES} benchmark::benchmark_main crisp_allocator
                        crisp_settings)
  set_target_properties(${name}_bench PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bench")
  add_dependencies(benchmarks ${name}_bench)
endfunction()
