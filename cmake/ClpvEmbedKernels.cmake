# SPDX-License-Identifier: MIT
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
