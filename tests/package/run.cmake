# cmake -DBUILD=build -DCONSUMER=tests/package -DWORK=folder -DGENERATOR=g -P run.cmake
# Installs clpv into a folder of its own, builds a consumer against that alone and runs both programs.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${status}: ${ARGN}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK}/build -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/consumer)
run(${WORK}/prefix/bin/clpv devices)
# The package that draws came along, and the program takes that one.
file(WRITE ${WORK}/prefix/share/clpv/clpv_draw/__main__.py "raise SystemExit('installed')")
execute_process(COMMAND ${WORK}/prefix/bin/clpv basis sh2 --figures ${WORK}/figures ERROR_VARIABLE said)
if(NOT EXISTS ${WORK}/prefix/share/clpv/clpv_draw/page.html OR NOT said MATCHES "installed")
  message(FATAL_ERROR "the installed program does not use its own clpv_draw: ${said}")
endif()
