# SPDX-License-Identifier: MIT
# Registers each file of a GoogleTest program as one ctest test: STEM for STEM_test.cpp. A file's tests share one process, and so
# the device and compiled kernels.
#
#   cmake -DPROGRAM=FILE -DOUTPUT=FILE.cmake -DCACHE=FOLDER -P discover_tests.cmake
#
# All tests keep compiled programs in CACHE: clpv's, and PoCL's unless POCL_CACHE_DIR is set. PATH begins with /usr/bin, since drawing
# needs the modules of Debian's Python. Time-outs have room for a machine five times slower. LONG tests start first, so that none of them runs alone at the end.
cmake_minimum_required(VERSION 3.22)
set(LONG check killed helpers drawing starved bench soak quality hostile sequence frame)
execute_process(COMMAND ${PROGRAM} --gtest_list_tests --gtest_output=json:${OUTPUT}.json OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(STRINGS ${OUTPUT}.json lines REGEX "\"(name|file)\":")
foreach(line IN LISTS lines)
  string(REGEX MATCH "^( *)\"(name|file)\": \"(.*)\",$" matched "${line}")
  string(LENGTH "${CMAKE_MATCH_1}" indentation)
  if(CMAKE_MATCH_2 STREQUAL "file")
    string(REGEX REPLACE ".*/([^/]*)_test\\\\?\\.cpp$" "\\1" stem "${CMAKE_MATCH_3}")
    list(APPEND stems ${stem})
    list(APPEND filter_${stem} "${suite}.${test}")
  elseif(indentation LESS 8)
    set(suite "${CMAKE_MATCH_3}")
  else()
    set(test "${CMAKE_MATCH_3}")
  endif()
endforeach()
list(REMOVE_DUPLICATES stems)
set(text "")
foreach(stem IN LISTS stems)
  set(cost 0)
  if(stem IN_LIST LONG)
    set(cost 100)
  endif()
  list(JOIN filter_${stem} ":" filter)
  string(APPEND text "add_test([[${stem}]] [[${PROGRAM}]] [[--gtest_filter=${filter}]])\n"
    "set_tests_properties([[${stem}]] PROPERTIES TIMEOUT 3000 COST ${cost} ENVIRONMENT [[XDG_CACHE_HOME=${CACHE}]]\n"
    "  ENVIRONMENT_MODIFICATION PATH=path_list_prepend:/usr/bin)\n")
endforeach()
file(WRITE ${OUTPUT} "${text}")
