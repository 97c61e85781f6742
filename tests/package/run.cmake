# SPDX-License-Identifier: MIT
# cmake -DBUILD=build -DSOURCE=project -DWORK=folder -DGENERATOR=g -DCOMPILER=c++ -DARCHITECTURE=a-b-c -P run.cmake
# Installs clpv into an empty folder, builds examples/ against that installation and runs both programs. Then configures the library
# without the program and its dependencies.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${status}: ${ARGN}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
# A build of the target clpv alone has no man page, and is installed without it.
if(EXISTS ${BUILD}/clpv.1)
  file(RENAME ${BUILD}/clpv.1 ${BUILD}/clpv.1.kept)
endif()
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix "${WORK}/without page"
                OUTPUT_VARIABLE said ERROR_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
if(EXISTS ${BUILD}/clpv.1.kept)
  file(RENAME ${BUILD}/clpv.1.kept ${BUILD}/clpv.1)
endif()
run("${WORK}/without page/bin/clpv" --version)
# It prints the line by which Python finds the module, also in a folder with a space.
if(EXISTS ${BUILD}/python/clpv/__init__.py AND said MATCHES "_native")
  if(NOT said MATCHES "export PYTHONPATH=[^\n]+")
    message(FATAL_ERROR "cmake --install names no PYTHONPATH: ${said}")
  endif()
  run(bash -c "${CMAKE_MATCH_0}; /usr/bin/python3 -B -c \"import clpv; assert clpv.__file__.startswith('${WORK}/without page/'), clpv.__file__; clpv.devices()\"")
endif()
# The build folder on PATH is no package.
file(WRITE ${WORK}/finder/CMakeLists.txt
     "cmake_minimum_required(VERSION 3.22)\nproject(finder CXX)\nfind_package(clpv QUIET)\nif(clpv_DIR)\nmessage(FATAL_ERROR \"found \${clpv_DIR}\")\nendif()\n")
run(${CMAKE_COMMAND} -E env PATH=${BUILD}:$ENV{PATH} ${CMAKE_COMMAND} -S ${WORK}/finder -B ${WORK}/finder/build -G ${GENERATOR})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
# The demo explains itself without a build.
execute_process(COMMAND ${SOURCE}/scripts/demo --help OUTPUT_VARIABLE said ERROR_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
if(NOT said MATCHES "RENDER_OPTION")
  message(FATAL_ERROR "scripts/demo --help: ${said}")
endif()
run(${CMAKE_COMMAND} -S ${SOURCE}/examples -B ${WORK}/build -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/build)
# The library itself prints nothing.
execute_process(COMMAND ${WORK}/build/render_cornell ${SOURCE}/scenes/cornell.json ${WORK}/cornell.png
                OUTPUT_VARIABLE said ERROR_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
if(NOT said MATCHES "^mean indirect green radiance: [0-9.e-]+\n$")
  message(FATAL_ERROR "render_cornell printed more than its line: ${said}")
endif()
run(${WORK}/build/walk ${SOURCE}/scenes/cornell.json ${WORK}/walk.png)
run(${WORK}/build/raycast ${SOURCE}/scenes/cornell.json ${WORK}/raycast.exr)
run(${WORK}/prefix/bin/clpv devices)
# Without the libraries that only clpv's own sources need, and with all warnings.
run(${CMAKE_COMMAND} -S ${SOURCE}/tests/package/consumer -B ${WORK}/consumer -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${WORK}/prefix
    -DCMAKE_DISABLE_FIND_PACKAGE_glm=ON -DCMAKE_DISABLE_FIND_PACKAGE_nlohmann_json=ON)
run(${CMAKE_COMMAND} --build ${WORK}/consumer)
execute_process(COMMAND nm --dynamic --defined-only ${WORK}/consumer/libplugin.so OUTPUT_VARIABLE exported COMMAND_ERROR_IS_FATAL ANY)
if(exported MATCHES "clpv" OR exported MATCHES " u " OR NOT exported MATCHES "plugin_width")
  message(FATAL_ERROR "a plugin exports symbols of clpv, or unique ones: ${exported}")
endif()
execute_process(COMMAND nm --extern-only --defined-only ${BUILD}/libclpv.a OUTPUT_VARIABLE exported ERROR_QUIET)
string(REGEX REPLACE " T clpv_[a-z_]*\n" "" exported "${exported}")
if(exported MATCHES " T [a-z][a-z_]*\n")
  message(FATAL_ERROR "libclpv.a has a global C symbol: ${CMAKE_MATCH_0}")
endif()
file(GLOB targets ${WORK}/prefix/lib*/cmake/clpv/*.cmake ${WORK}/prefix/lib/*/cmake/clpv/*.cmake)
foreach(target IN LISTS targets)
  file(STRINGS ${target} absolute REGEX "\"/usr/|;/usr/|/usr/lib")
  if(absolute)
    message(FATAL_ERROR "${target}: paths of this machine: ${absolute}")
  endif()
endforeach()
# The same program with pkg-config, if installed.
find_program(PKG_CONFIG pkg-config)
if(PKG_CONFIG)
  set(ENV{PKG_CONFIG_PATH} ${WORK}/prefix/lib/pkgconfig:${WORK}/prefix/lib/${ARCHITECTURE}/pkgconfig)
  execute_process(COMMAND ${PKG_CONFIG} --cflags --libs clpv OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE
                  COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags)
  run(${COMPILER} -std=c++20 ${SOURCE}/examples/render_cornell.cpp ${flags} -o ${WORK}/by_pkg_config)
  execute_process(COMMAND ${WORK}/by_pkg_config none.json RESULT_VARIABLE status ERROR_VARIABLE said)  # it starts
  if(NOT status EQUAL 3 OR NOT said MATCHES "none.json")
    message(FATAL_ERROR "by_pkg_config ended with ${status}: ${said}")
  endif()
endif()
# The man page is installed if help2man is, and names the options of commands.
find_program(HELP2MAN help2man)
if(HELP2MAN)
  file(READ ${WORK}/prefix/share/man/man1/clpv.1 page)
  if(NOT page MATCHES "sequence" OR NOT page MATCHES "transport" OR NOT page MATCHES "CLPV_DEVICE" OR
     NOT page MATCHES "EXAMPLES")
    message(FATAL_ERROR "the man page lacks commands or their options")
  endif()
endif()
# Installed headers are one folder, and include only each other and the standard library. Below it are the kernels'
# headers that Renderer::lookup_source() is made of.
file(GLOB_RECURSE headers RELATIVE ${WORK}/prefix/include ${WORK}/prefix/include/*)
list(FILTER headers EXCLUDE REGEX "^clpv/kernels/.*\\.h$")
if(NOT EXISTS ${WORK}/prefix/include/clpv/kernels/gather/lookup.h)
  message(FATAL_ERROR "clpv/kernels/gather/lookup.h: not installed")
endif()
foreach(header IN LISTS headers)
  file(STRINGS ${WORK}/prefix/include/${header} private REGEX "#include \"" )
  list(FILTER private EXCLUDE REGEX "\"clpv/")
  if(private OR NOT header MATCHES "^clpv/[a-z_]+\\.hpp$")
    message(FATAL_ERROR "${header}: installed, but private: ${private}")
  endif()
endforeach()
# The drawing package is installed, and the program uses it.
file(GLOB package ${WORK}/prefix/lib/python3*/*-packages/clpv)
file(WRITE ${package}/draw/__main__.py "raise SystemExit('installed')")
file(WRITE ${WORK}/quality.json "{\"variants\": []}")
execute_process(COMMAND ${WORK}/prefix/bin/clpv report ${WORK}/page --quality ${WORK}/quality.json ERROR_VARIABLE said)
if(NOT EXISTS ${package}/draw/page.html OR NOT said MATCHES "installed")
  message(FATAL_ERROR "the installed program does not use its own clpv.draw: ${said}")
endif()
# As a part of another project, whose build type, package, tests and installation stay its own.
file(WRITE ${WORK}/parent/CMakeLists.txt "cmake_minimum_required(VERSION 3.22)
project(parent VERSION 9.9 LANGUAGES C CXX)
set(CPACK_PACKAGE_NAME parent)
set(CPACK_PACKAGE_CONTACT p@localhost)
enable_testing()
add_subdirectory(${SOURCE} clpv)
add_executable(app ${SOURCE}/examples/render_cornell.cpp)
target_link_libraries(app PRIVATE clpv::clpv)
add_test(NAME app COMMAND app ${SOURCE}/scenes/cornell.json app.png)
install(TARGETS app)
include(CPack)\n")
run(${CMAKE_COMMAND} -S ${WORK}/parent -B ${WORK}/parent/build -G ${GENERATOR} -DCLPV_PREBUILT=${BUILD}/libclpv.a)
run(${CMAKE_COMMAND} --build ${WORK}/parent/build)
run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/parent/build --no-tests=error)
run(${CMAKE_COMMAND} --install ${WORK}/parent/build --prefix ${WORK}/parent/prefix)
file(GLOB_RECURSE installed RELATIVE ${WORK}/parent/prefix ${WORK}/parent/prefix/*)
file(STRINGS ${WORK}/parent/build/CMakeCache.txt type REGEX "^CMAKE_BUILD_TYPE:STRING=.")
file(STRINGS ${WORK}/parent/build/CPackConfig.cmake name REGEX "CPACK_PACKAGE_NAME \"parent\"")
if(NOT installed STREQUAL "bin/app" OR type OR NOT name)
  message(FATAL_ERROR "a project with clpv installs ${installed}; its build type: ${type}; its package: ${name}")
endif()
# Flags that remove checks of NaN end configuration, and compilation, by name.
foreach(command "${CMAKE_COMMAND};-S;${SOURCE};-B;${WORK}/fast;-G;${GENERATOR};-DCMAKE_CXX_FLAGS=-ffast-math"
        "${COMPILER};-std=c++20;-ffinite-math-only;-fsyntax-only;-I${SOURCE}/host;-I${SOURCE}/include;${SOURCE}/host/support/error.cpp")
  execute_process(COMMAND ${command} RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE said)
  if(status EQUAL 0 OR NOT said MATCHES "found [^\n]*-f[a-z]+-math")
    message(FATAL_ERROR "${command}: ${status}: ${said}")
  endif()
endforeach()
# The library without the program.
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/library -G ${GENERATOR} -DCLPV_BUILD_PROGRAM=OFF
    -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON -DCMAKE_DISABLE_FIND_PACKAGE_benchmark=ON
    -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON)
