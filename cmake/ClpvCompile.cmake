# SPDX-License-Identifier: MIT
# Compiler settings of all targets.

# Precompiles library headers that many units include. Excludes json.hpp: every unit that includes it also instantiates its
# templates, which takes longer than parsing it where it is used. Targets of one or two units have none: each is 110 MB.
option(CLPV_PRECOMPILE "Precompile the headers that most units share" ON)

function(clpv_precompile target)
  if(CLPV_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE
      <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory> <optional> <set> <string>
      <string_view> <tuple> <utility> <vector>
      <CL/opencl.hpp> <fmt/format.h> <glm/glm.hpp> <nlohmann/json_fwd.hpp> ${ARGN})
  endif()
endfunction()

# Warnings. A switch that misses a value of an enumeration is always an error.
option(CLPV_WERROR "Treat warnings as errors" OFF)

function(clpv_warn target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Werror=switch $<$<BOOL:${CLPV_WERROR}>:-Werror>)
endfunction()

# For what runs once and computes little: the command line, the tests. The CPU references and the path tracer are the library's.
function(clpv_compile_quickly target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# Unity builds, 3x faster: the rule is in CONTRIBUTING.md.
option(CLPV_UNITY "Compile files of a folder together" ON)

# clpv_group(target folder...): compiles each folder as one unit.
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

# clpv_embed(out_variable folder table pattern...): embeds all files of a folder into one C++ file, so that the program needs no
# such files at run time. `table`: the function in clpv::detail that returns them.
function(clpv_embed out_variable folder table)
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/ OUTPUT_VARIABLE patterns)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${patterns})
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${table}.cpp)
  set(script ${CMAKE_CURRENT_SOURCE_DIR}/cmake/embed_kernels.cmake)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DROOT=${CMAKE_CURRENT_SOURCE_DIR}/${folder} -DOUTPUT=${output} -DTABLE=${table}
            "-DPATTERNS=${ARGN}" -P ${script}
    DEPENDS ${files} ${script}
    COMMENT "Embedding ${folder}" VERBATIM)
  set(${out_variable} ${output} PARENT_SCOPE)
endfunction()
