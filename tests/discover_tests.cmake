# SPDX-License-Identifier: MIT
# Registers each file of a GoogleTest program as one ctest test: STEM for STEM_test.cpp. A file's tests share one process, and so
# the device and compiled kernels. Suites whose names begin with Long are STEM.long, which `scripts/test --long` runs
# (`ctest --build-config long`).
#
#   cmake -DPROGRAM=FILE -DOUTPUT=FILE.cmake -DCACHE=FOLDER -P discover_tests.cmake
#
# All tests keep compiled programs in CACHE: clpv's, and PoCL's unless POCL_CACHE_DIR is set. PATH begins with /usr/bin, since drawing
# needs the modules of Debian's Python. Time-outs have room for a machine five times slower. FIRST are the longest, so that none of
# them runs alone at the end, in an order in which two that run at once compile different programs.
cmake_minimum_required(VERSION 3.22)
# DEVELOPER are left out of `scripts/test` without options.
set(FIRST check starved helpers bench killed frame_cache opencl frame rooms quality trust sequence programs)
set(DEVELOPER baseline capsules killed mpi starved trust)
execute_process(COMMAND ${PROGRAM} --gtest_list_tests --gtest_output=json:${OUTPUT}.json OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(STRINGS ${OUTPUT}.json lines REGEX "\"(name|file)\":")
foreach(line IN LISTS lines)
  string(REPLACE "\\/" "/" line "${line}")  # JSON escapes the slash of parametrised tests
  string(REGEX MATCH "^( *)\"(name|file)\": \"(.*)\",$" matched "${line}")
  string(LENGTH "${CMAKE_MATCH_1}" indentation)
  if(CMAKE_MATCH_2 STREQUAL "file")
    string(REGEX REPLACE ".*/([^/]*)_test\\.cpp$" "\\1" stem "${CMAKE_MATCH_3}")
    list(APPEND stems ${stem})
    list(APPEND ${kind}_${stem} "${suite}.${test}")
  elseif(indentation LESS 8)
    set(suite "${CMAKE_MATCH_3}")
  else()
    set(test "${CMAKE_MATCH_3}")
    set(kind usual)
    if(suite MATCHES "^Long")
      set(kind long)
    endif()
  endif()
endforeach()
list(REMOVE_DUPLICATES stems)
set(text "")

# Appends a test of ctest with these tests of the program.
function(append name tests properties)
  list(JOIN tests ":" filter)
  string(APPEND text "add_test([[${name}]] [[${PROGRAM}]] [[--gtest_filter=${filter}]])\n"
    "set_tests_properties([[${name}]] PROPERTIES TIMEOUT 3000 ${properties} ENVIRONMENT [[XDG_CACHE_HOME=${CACHE};MPLCONFIGDIR=${CACHE}/matplotlib]]\n"
    "  ENVIRONMENT_MODIFICATION PATH=path_list_prepend:/usr/bin)\n")
  set(text "${text}" PARENT_SCOPE)
endfunction()

foreach(stem IN LISTS stems)
  list(FIND FIRST ${stem} place)
  set(cost 0)
  if(NOT place EQUAL -1)
    math(EXPR cost "100 - ${place}")
  endif()
  if(usual_${stem})
    set(labels "")
    if(stem IN_LIST DEVELOPER)
      set(labels "LABELS developer")
    endif()
    append(${stem} "${usual_${stem}}" "COST ${cost} ${labels}")
  endif()
  if(long_${stem})
    string(APPEND text "if(CTEST_CONFIGURATION_TYPE STREQUAL long)\n")
    append(${stem}.long "${long_${stem}}" "LABELS long")
    string(APPEND text "endif()\n")
  endif()
endforeach()

file(WRITE ${OUTPUT} "${text}")
