# SPDX-License-Identifier: MIT
# cmake -DGIT=git -DSOURCE=folder -DOUTPUT=file.h -P git_describe.cmake
# Writes a header that defines CLPV_GIT_DESCRIBE; "unknown" without git, and in a source archive, which may lie in another
# repository.
cmake_minimum_required(VERSION 3.22)
set(described unknown)
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT} describe --always --dirty --tags WORKING_DIRECTORY ${SOURCE}
                  OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
  if(NOT failed)
    set(described ${found})
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define CLPV_GIT_DESCRIBE \"@described@\"\n" @ONLY)
