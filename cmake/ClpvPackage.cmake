# SPDX-License-Identifier: MIT
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
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-matplotlib, python3-jinja2, python3-scipy")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "openmpi-bin, libglm-dev, libfmt-dev, nlohmann-json3-dev, libopenimageio-dev, openimageio-tools, libembree-dev, libtinygltf-dev, ocl-icd-opencl-dev")
include(CPack)
