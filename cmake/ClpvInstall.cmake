# SPDX-License-Identifier: MIT
# Installs bin/clpv, the Python package that it draws with, the library, its headers, and a CMake package (find_package(clpv), link
# clpv::clpv).
include(CMakePackageConfigHelpers)
if(CLPV_BUILD_PROGRAM AND SKBUILD)  # in the wheel's package, where python/clpv/__main__.py finds them
  install(TARGETS clpv RUNTIME DESTINATION clpv/bin COMPONENT python)
  set_target_properties(clpv PROPERTIES INSTALL_RPATH "$ORIGIN/..")
  install(FILES scenes/atrium.json scenes/atrium.glb scenes/cornell.json scenes/cornell.glb
          DESTINATION clpv/scenes COMPONENT python)
elseif(CLPV_BUILD_PROGRAM)
  install(TARGETS clpv RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  find_program(HELP2MAN help2man)
  if(HELP2MAN)
    set(page ${CMAKE_CURRENT_BINARY_DIR}/clpv.1)
    add_custom_command(OUTPUT ${page}
      COMMAND ${HELP2MAN} --no-info --help-option=--help-all "--name=${PROJECT_DESCRIPTION}"
              --include=${CMAKE_CURRENT_SOURCE_DIR}/docs/manual_sections.h2m --output=${page} $<TARGET_FILE:clpv>
      DEPENDS clpv docs/manual_sections.h2m VERBATIM)
    add_custom_target(clpv_pages ALL DEPENDS ${page})
    install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL)  # a build of the target clpv alone has none
  else()
    list(APPEND CLPV_ABSENT "help2man")
  endif()
endif()
install(TARGETS clpv_library EXPORT clpvTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/clpv DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")
# Headers for Renderer::lookup_source(), and the structs in the buffers that opencl.hpp returns.
install(DIRECTORY kernels DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/clpv FILES_MATCHING PATTERN "*.h")
install(EXPORT clpvTargets NAMESPACE clpv:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/clpv)
# A separate folder: find_package searches folders of PATH, and the build folder may be one.
set(package ${CMAKE_CURRENT_BINARY_DIR}/package)
configure_package_config_file(cmake/clpvConfig.cmake.in ${package}/clpvConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/clpv)
file(RELATIVE_PATH CLPV_PREFIX_FROM_PC /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
if(CLPV_IMAGES)
  set(CLPV_PC_IMAGES " OpenImageIO")
endif()
if(TINYGLTF_LIBRARY)
  set(CLPV_PC_TINYGLTF " -ltinygltf")
endif()
if(CLPV_PATHTRACER)
  set(CLPV_PC_EMBREE " -l${CLPV_EMBREE_LIBRARY}")
endif()
configure_file(cmake/clpv.pc.in ${CMAKE_CURRENT_BINARY_DIR}/clpv.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/clpv.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
write_basic_package_version_file(${package}/clpvConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${package}/clpvConfig.cmake ${package}/clpvConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/clpv)

# `cpack -G DEB` in the build folder: program, library, headers, man page and Python module as a package of Debian.
set(CPACK_PACKAGE_NAME clpv)
set(CPACK_PACKAGE_CONTACT "The authors of clpv <clpv@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_CURRENT_SOURCE_DIR}/LICENSE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
# Libraries come from program and module (dpkg-shlibdeps). Any OpenCL device will do; several ranks need Open MPI, linking the static
# library the -dev packages.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "pocl-opencl-icd | opencl-icd, python3, python3-numpy")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_SOURCE_DIR}/cmake/prerm)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_SOURCE_DIR}/cmake/package_shlibs.cmake)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-matplotlib, python3-jinja2")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "openmpi-bin, libglm-dev, libfmt-dev, nlohmann-json3-dev, libopenimageio-dev, openimageio-tools, libembree-dev, libtinygltf-dev, ocl-icd-opencl-dev")
include(CPack)
