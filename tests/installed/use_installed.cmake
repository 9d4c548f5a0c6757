# SPDX-License-Identifier: BSD-3-Clause
# Installs the build, moves it, compiles each public header alone against it, builds the examples, and runs them and
# crisp with their plugin.
cmake_minimum_required(VERSION 3.25)

set(work "${build}/installed_package")
set(prefix "${work}/moved")
set(crisp "${prefix}/bin/crisp")
set(project "${CMAKE_CURRENT_LIST_DIR}/../examples")
unset(ENV{LD_LIBRARY_PATH})
unset(ENV{CRISP_PLUGINS})

function(run)
  execute_process(COMMAND ${ARGV} OUTPUT_VARIABLE out ERROR_VARIABLE out RESULT_VARIABLE status)
  if(status)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\nended with ${status}:\n${out}")
  endif()
  set(output "${out}" PARENT_SCOPE)
endfunction()

function(expect_output text)
  string(FIND "${output}" "${text}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "'${text}' is not in:\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE "${work}")

# What ./demo builds is all that is installed.
run(${ninja} -C "${build}" -t commands crisp_installed)
set(built "${output}")
file(GLOB_RECURSE scripts "${build}/cmake_install.cmake")
set(installed)
foreach(script IN LISTS scripts)
  file(STRINGS "${script}" lines REGEX "\"${build}/[^\"]*\\.(a|so|bash)\"")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^.*\"${build}/([^\"]*)\".*$" "\\1" file "${line}")
    list(APPEND installed "${file}")
  endforeach()
endforeach()
if(NOT installed)
  message(FATAL_ERROR "no library is installed")
endif()
foreach(file IN LISTS installed)
  string(FIND "${built}" "${file}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "${file} is installed, but crisp_installed does not build it")
  endif()
endforeach()

run(${CMAKE_COMMAND} --install "${build}" --prefix "${work}/installed")
file(RENAME "${work}/installed" "${prefix}")  # nothing may depend on where it was installed

# build_against_installed(<source folder> <build folder>)
function(build_against_installed source folder)
  run(${CMAKE_COMMAND} -G Ninja -S "${source}" -B "${folder}" -D CMAKE_PREFIX_PATH=${prefix}
      -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_BUILD_TYPE=Debug)
  run(${CMAKE_COMMAND} --build "${folder}")
endfunction()

# The public headers are all that is installed, and none needs another one before it.
file(GLOB public RELATIVE "${CMAKE_CURRENT_LIST_DIR}/../../pipeline/include"
     "${CMAKE_CURRENT_LIST_DIR}/../../pipeline/include/crisp/*.hpp")
file(GLOB_RECURSE headers RELATIVE "${prefix}/${include}" "${prefix}/${include}/*")
if(NOT public OR NOT "${headers}" STREQUAL "${public}")
  message(FATAL_ERROR "the public headers are ${public}, but these are installed: ${headers}")
endif()
build_against_installed("${CMAKE_CURRENT_LIST_DIR}/headers" "${work}/headers")

build_against_installed("${project}" "${work}/build")

# A plugin that is named
run(${crisp} plugins --plugin "${work}/build/example.so")
expect_output("example.near")
run(${crisp} run "${project}/near.yaml" -i "${project}/cloud.pcd" -o "${work}/out" --plugin "${work}/build/example.so")
file(READ "${work}/out/near.pcd" cloud)
if(NOT cloud MATCHES "POINTS 2\n.*\n1 1 0 7 2 9 0.25\n0 -2 0 8 0 3 0.5\n$")
  message(FATAL_ERROR "the example's stage did not keep the two points that are near:\n${cloud}")
endif()

# An installed plugin is found by itself; its term bends a simulation by its parameter.
run(${CMAKE_COMMAND} --install "${work}/build" --prefix "${prefix}")
run(${crisp} stages example.near)
expect_output("radius")
run(${crisp} effects example.drift)
expect_output("rate")
foreach(rate IN ITEMS 0 0.1)
  run(${crisp} run "${project}/drift.yaml" -o "${work}/drift_${rate}"
      --set "grabber.simulate.effects={example.drift: {rate: ${rate}}}")
endforeach()
run("${work}/build/compare_ranges" "${work}/drift_0/beams.pcd" "${work}/drift_0.1/beams.pcd" 0.1)

# What hides in a capture is named by the plugin's term, and the calibration extended by it.
set(configs "${prefix}/share/crisp/configs")
run(${crisp} run "${configs}/simulate.yaml" -o "${work}/hidden" --set grabber.simulate.duration=4s
    --set "grabber.simulate.effects={laser3.example.ripple: {a: 11mm}}")
run(${crisp} run "${configs}/diagnose.yaml" -i "${work}/hidden/hub.pcap" -o "${work}/diagnosed")
file(READ "${work}/diagnosed/diagnosis.json" diagnosis)
string(JSON findings LENGTH "${diagnosis}" findings)
string(JSON cause GET "${diagnosis}" findings 0 cause)
string(JSON scope GET "${diagnosis}" findings 0 scope)
if(NOT "${findings} ${cause} ${scope}" STREQUAL "1 example.ripple laser3")
  message(FATAL_ERROR "a ripple was hidden in laser3, but this was found:\n${diagnosis}")
endif()
file(READ "${work}/diagnosed/calibration.yaml" calibration)
if(NOT calibration MATCHES "example.ripple")
  message(FATAL_ERROR "the calibration does not hold what was found:\n${calibration}")
endif()

# The plugin's measure can be minimized.
file(WRITE "${work}/spread.yaml" "crisp: 1
pipeline:
  - stage: grabber.capture
    with: {file: \"${work}/hidden/hub.pcap\"}
  - stage: clock.convex_hull
  - stage: calibrate.rqe
    with: {measure: example.spread}
")
run(${crisp} validate "${work}/spread.yaml")

# A diagnosis in a program, with the plugin's term among the candidates
run("${work}/build/diagnose_capture" "${work}/hidden/hub.pcap" "${work}/build/example.so")
if(NOT output MATCHES "laser3: example.ripple, a = ([0-9.]+) ± [^ ]+ m\n1 findings\n")
  message(FATAL_ERROR "a ripple was hidden in laser3, but the program found this:\n${output}")
endif()
if(CMAKE_MATCH_1 LESS 0.0108 OR CMAKE_MATCH_1 GREATER 0.0112)  # [m] four standard errors about the truth
  message(FATAL_ERROR "the ripple's amplitude is 11 mm, but the program found ${CMAKE_MATCH_1} m")
endif()

# Programs of PCL's manner
run("${work}/build/cloud_entropy" "${project}/cloud.pcd" 4)
expect_output(" of 3 points, RQE ")
run(${crisp} run "${configs}/simulate.yaml" -o "${work}/made" --set grabber.simulate.duration=1s)
run("${work}/build/count_scans")
run("${work}/build/count_scans" "${work}/made/hub.pcap")
expect_output("150 scans, ")
