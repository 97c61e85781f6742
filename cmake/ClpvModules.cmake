# SPDX-License-Identifier: MIT
# Modules that clpv loads when it needs them.

if(CLPV_IMAGES)
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
endif()

# Builds the MPI module that clpv loads if an MPI launcher started it. Otherwise the program neither needs nor loads MPI.
option(CLPV_MPI "Support several MPI ranks, if MPI is found" ON)
set(CLPV_MPIEXEC "")
if(CLPV_MPI)
  find_package(MPI QUIET COMPONENTS C)
endif()
if(CLPV_MPI AND MPI_C_FOUND)
  add_library(clpv_mpi MODULE host/parallel/mpi_communicator.cpp)
  set_target_properties(clpv_mpi PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY $<TARGET_FILE_DIR:clpv>)
  target_include_directories(clpv_mpi PRIVATE host)
  target_compile_definitions(clpv_mpi PRIVATE OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX)  # skips the C++ bindings that MPI 3 removed
  target_link_libraries(clpv_mpi PRIVATE MPI::MPI_C Threads::Threads)
  clpv_warn(clpv_mpi)
  add_dependencies(clpv clpv_mpi)
  install(TARGETS clpv_mpi LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/clpv)
  set(CLPV_MPIEXEC ${MPIEXEC_EXECUTABLE})
elseif(CLPV_MPI)
  list(APPEND CLPV_ABSENT "MPI (libopenmpi-dev)")
endif()
