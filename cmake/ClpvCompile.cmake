# SPDX-License-Identifier: MIT
# How every target is compiled.

# Headers of others that many units include and that take long to parse, precompiled. Not json.hpp: what including it
# instantiates is instantiated in every unit all the same, which takes longer than parsing it where it is needed.
option(CLPV_PRECOMPILE "Precompile the headers that most units share" ON)

function(clpv_precompile target)
  if(CLPV_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE
      <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory> <optional> <set> <string>
      <string_view> <tuple> <utility> <vector>
      <CL/opencl.hpp> <fmt/format.h> <glm/glm.hpp> <nlohmann/json_fwd.hpp> ${ARGN})
  endif()
endfunction()

# Warnings; a switch over an enumeration that leaves a value out is an error everywhere.
option(CLPV_WERROR "Treat warnings as errors" OFF)

function(clpv_warn target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Werror=switch $<$<BOOL:${CLPV_WERROR}>:-Werror>)
endfunction()

# For what runs once and computes little: the command line, the tests. The CPU references and the path tracer are the library's.
function(clpv_compile_quickly target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# Files of a folder compile as one unit, which takes a third of the time. Names in a folder must then differ, those in
# anonymous namespaces too.
option(CLPV_UNITY "Compile files of a folder together" ON)

# clpv_group(target folder...): each of these folders becomes a unit.
function(clpv_group target)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(GET folder FILENAME folder)
    if(folder IN_LIST ARGN)
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder})
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${CLPV_UNITY} UNITY_BUILD_MODE GROUP)
endfunction()
