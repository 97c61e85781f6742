# SPDX-License-Identifier: MIT
# Embeds all files of kernels/ into one C++ file, so that the program needs no kernel files at run time.
function(clpv_embed_kernels out_variable)
  file(GLOB_RECURSE kernel_files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/kernels/*.cl
       ${CMAKE_CURRENT_SOURCE_DIR}/kernels/*.h)
  list(SORT kernel_files)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/embedded_kernels.cpp)
  set(script ${CMAKE_CURRENT_SOURCE_DIR}/cmake/embed_kernels.cmake)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DROOT=${CMAKE_CURRENT_SOURCE_DIR}/kernels -DOUTPUT=${output} -P ${script}
    DEPENDS ${kernel_files} ${script}
    COMMENT "Embedding the kernels" VERBATIM)
  set(${out_variable} ${output} PARENT_SCOPE)
endfunction()
