# SPDX-License-Identifier: MIT
# Lists the suites of a program of GoogleTest as tests of ctest: one process a suite, which opens the device and compiles what its
# tests share once. (A process a test takes twice as long over the whole: its start is half a second.)
#
#   cmake -DPROGRAM=FILE -DOUTPUT=FILE.cmake -P discover_suites.cmake
#
# PATH begins with /usr/bin: drawing takes Debian's Python, which has the modules it needs.
# LONG_SUITES begin first, so that none of them is left to run alone at the end.
cmake_minimum_required(VERSION 3.22)
set(LONG_SUITES Killed Names/EveryBasis HostileSurroundings TuneProgram Names/PropagateKernels Starved HostileCommandLines
  BenchProgram ManyAtOnce Drawing HostileScenes Names/InjectKernels SequenceTest Frame Names/GatherKernels HostileFiles)
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "(^|\n)[^ \n]+\\." lines "${listed}")
set(text "")
foreach(line IN LISTS lines)
  string(REGEX REPLACE "^\n|\\.$" "" suite "${line}")
  set(cost 0)
  if(suite IN_LIST LONG_SUITES)
    set(cost 100)
  endif()
  string(APPEND text "add_test([[${suite}]] [[${PROGRAM}]] [[--gtest_filter=${suite}.*]])\n"
    "set_tests_properties([[${suite}]] PROPERTIES TIMEOUT 900 COST ${cost} ENVIRONMENT CLPV_PROGRAM_CACHE=off
    ENVIRONMENT_MODIFICATION PATH=path_list_prepend:/usr/bin)\n")
endforeach()
file(WRITE ${OUTPUT} "${text}")
