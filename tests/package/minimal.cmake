# SPDX-License-Identifier: MIT
# cmake -DSOURCE=project -DWORK=folder -DGENERATOR=g -DCOMPILER=c++ -DCLPV=program -P minimal.cmake
# Builds the program without Embree and OpenImageIO, for this CPU, whose fused multiply-adds must change nothing: kernels pass `check`, an image has the bytes of the whole program's, and what is
# missing is named.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE errors)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${status}: ${ARGN}\n${said}${errors}")
  endif()
  set(said "${said}" PARENT_SCOPE)
endfunction()

# expect(code text command...): the command ends with the code and says the text.
function(expect code text)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE errors)
  if(NOT status EQUAL code OR NOT "${said}${errors}" MATCHES "${text}")
    message(FATAL_ERROR "found code ${status}; wanted ${code} and '${text}': ${ARGN}\n${said}${errors}")
  endif()
endfunction()

run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
    -DCLPV_PATHTRACER=OFF -DCLPV_IMAGES=OFF -DCLPV_MPI=OFF -DCMAKE_CXX_FLAGS=-march=native
    -DCMAKE_DISABLE_FIND_PACKAGE_embree=ON -DCMAKE_DISABLE_FIND_PACKAGE_OpenImageIO=ON -DCMAKE_DISABLE_FIND_PACKAGE_Python=ON
    -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON)
run(${CMAKE_COMMAND} --build ${WORK} --target clpv --parallel 2)
set(minimal ${WORK}/clpv)
run(${minimal} check --lanes 8)
set(scene ${SOURCE}/scenes/cornell.json)
run(${minimal} render ${scene} --width 96 --height 54 -o ${WORK}/minimal.exr)
run(${CLPV} render ${scene} --width 96 --height 54 -o ${WORK}/whole.exr)
run(${CLPV} compare ${WORK}/minimal.exr ${WORK}/whole.exr)
if(NOT said MATCHES "\"identical\": true")
  message(FATAL_ERROR "images differ: ${said}")
endif()
expect(1 "without Embree" ${minimal} pathtrace ${scene} -o ${WORK}/truth.exr)
run(${minimal} compare ${WORK}/minimal.exr ${WORK}/minimal.exr)
expect(3 "without OpenImageIO" ${minimal} compare ${WORK}/minimal.exr ${WORK}/whole.exr)
