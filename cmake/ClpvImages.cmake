# SPDX-License-Identifier: MIT
# Builds the image codecs as a module that clpv loads with its first image: OpenImageIO's 260 libraries take 0.3 s to load.
add_library(clpv_images MODULE host/image/codec.cpp)
set_target_properties(clpv_images PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY $<TARGET_FILE_DIR:clpv>)
target_include_directories(clpv_images PRIVATE host)
target_link_libraries(clpv_images PRIVATE OpenImageIO::OpenImageIO)
clpv_warn(clpv_images)
add_dependencies(clpv clpv_images)
target_link_options(clpv PRIVATE -Wl,--as-needed)  # leaves OpenImageIO to the module
# dlopen searches the program's RPATH.
set_target_properties(clpv PROPERTIES BUILD_RPATH "$ORIGIN" INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}/clpv")
install(TARGETS clpv_images LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/clpv)
