# SPDX-License-Identifier: MIT
# Libraries, all from packages of Debian 12.
find_package(OpenCL REQUIRED)
find_package(glm REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_path(STB_INCLUDE_DIR stb/stb_image.h REQUIRED)
# Optional parts, found anew by each configuration: CLPV_IMAGES and CLPV_PATHTRACER become true or false below.
set(CLPV_ABSENT "")
if(CLPV_IMAGES STREQUAL AUTO)
  find_package(OpenImageIO QUIET)
  set(CLPV_IMAGES ON)
  if(NOT OpenImageIO_FOUND)
    set(CLPV_IMAGES OFF)
    list(APPEND CLPV_ABSENT "OpenImageIO (libopenimageio-dev openimageio-tools)")
  endif()
endif()
if(CLPV_IMAGES)
  find_package(OpenImageIO REQUIRED)
  # Debian's package lists include folders of OpenCV, which are not needed and may not exist.
  get_target_property(oiio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
  set(oiio_present)
  foreach(directory IN LISTS oiio_includes)
    if(EXISTS "${directory}")
      list(APPEND oiio_present "${directory}")
    endif()
  endforeach()
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${oiio_present}")
endif()
if(CLPV_BUILD_PROGRAM)
  find_package(CLI11 REQUIRED)
endif()
find_package(Threads REQUIRED)
# Embree 3 (Debian 12) or 4 (Debian 13); CLPV_EMBREE_MAJOR tells sources which.
if(CLPV_PATHTRACER)
  set(CLPV_EMBREE "" CACHE STRING "Version of Embree, 3 or 4; empty: the installed one, preferably 3")
  if(NOT CLPV_EMBREE STREQUAL "4")
    find_package(embree 3 QUIET)
  endif()
  if(NOT embree_FOUND AND NOT CLPV_EMBREE STREQUAL "3")
    find_package(embree 4 QUIET)
  endif()
  if(embree_FOUND)
    set(CLPV_PATHTRACER ON)
  elseif(CLPV_PATHTRACER STREQUAL AUTO)
    set(CLPV_PATHTRACER OFF)
    list(APPEND CLPV_ABSENT "Embree (libembree-dev)")
  else()
    message(FATAL_ERROR "Embree ${CLPV_EMBREE} not found; on Debian: apt install libembree-dev")
  endif()
  set(CLPV_EMBREE_MAJOR ${embree_VERSION_MAJOR})
  if(NOT CLPV_EMBREE_MAJOR)
    string(REGEX MATCH "^[0-9]+" CLPV_EMBREE_MAJOR "${EMBREE_VERSION}${embree_VERSION}")
  endif()
  set(CLPV_EMBREE_LIBRARY embree${CLPV_EMBREE_MAJOR})
endif()
find_path(TINYGLTF_INCLUDE_DIR tiny_gltf.h REQUIRED)
find_library(TINYGLTF_LIBRARY tinygltf)
if(NOT TINYGLTF_LIBRARY)
  message(STATUS "tinygltf without a library: clpv compiles its header")
endif()
find_path(EIGEN_INCLUDE_DIR Eigen/Core PATH_SUFFIXES eigen3 REQUIRED)
# The program of a project that clpv is a part of links these, too.
if(NOT PROJECT_IS_TOP_LEVEL)
  get_property(imported DIRECTORY PROPERTY IMPORTED_TARGETS)
  set_target_properties(${imported} PROPERTIES IMPORTED_GLOBAL ON)
endif()

# Settings of sources that include host/: the library itself, program, benchmarks, tests, Python module. A program that links
# clpv::clpv gets none of them.
add_library(clpv_internal INTERFACE)
target_compile_definitions(clpv_internal INTERFACE
  CL_HPP_TARGET_OPENCL_VERSION=120 CL_HPP_MINIMUM_OPENCL_VERSION=120 CL_HPP_ENABLE_EXCEPTIONS
  CL_TARGET_OPENCL_VERSION=120 GLM_FORCE_EXPLICIT_CTOR)
target_include_directories(clpv_internal INTERFACE
  ${CMAKE_CURRENT_SOURCE_DIR}/include ${CMAKE_CURRENT_SOURCE_DIR}/host ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(clpv_internal INTERFACE
  OpenCL::OpenCL glm::glm fmt::fmt nlohmann_json::nlohmann_json Threads::Threads)

# For a tinygltf without a library: clpv decodes images by OpenImageIO.
if(NOT TINYGLTF_LIBRARY)
  target_compile_definitions(clpv_internal INTERFACE TINYGLTF_NO_STB_IMAGE TINYGLTF_NO_STB_IMAGE_WRITE)
  set(tinygltf_source ${CMAKE_CURRENT_BINARY_DIR}/tinygltf.cpp)
  file(CONFIGURE OUTPUT ${tinygltf_source} CONTENT
       "#include <nlohmann/json.hpp>\n#define TINYGLTF_NO_INCLUDE_JSON\n#define TINYGLTF_IMPLEMENTATION\n#include <tiny_gltf.h>\n")
endif()

# Public headers include CL/cl.h; what else the library links, its users link but do not compile with.
function(clpv_link_dependencies target)
  target_link_libraries(${target}
    PUBLIC OpenCL::OpenCL
    PRIVATE $<BUILD_INTERFACE:clpv_internal> fmt::fmt Threads::Threads
            $<$<BOOL:${CLPV_IMAGES}>:OpenImageIO::OpenImageIO> $<$<BOOL:${CLPV_PATHTRACER}>:embree>)
  if(TINYGLTF_LIBRARY)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:${TINYGLTF_LIBRARY}> $<INSTALL_INTERFACE:tinygltf>)
  endif()
  target_sources(${target} PRIVATE ${tinygltf_source})
  target_include_directories(${target} PRIVATE ${TINYGLTF_INCLUDE_DIR})
  target_include_directories(${target} SYSTEM PRIVATE ${EIGEN_INCLUDE_DIR})
endfunction()
