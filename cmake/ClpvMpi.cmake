# SPDX-License-Identifier: MIT
# What the program loads where mpirun or the like started it: a module of its own beside it, so that it neither needs MPI nor
# waits for its libraries elsewhere.
option(CLPV_MPI "clpv over many ranks, where MPI is found" ON)
set(CLPV_MPIEXEC "")
if(CLPV_MPI)
  find_package(MPI COMPONENTS C)
endif()
if(CLPV_MPI AND MPI_C_FOUND)
  add_library(clpv_mpi MODULE host/parallel/mpi_communicator.cpp)
  set_target_properties(clpv_mpi PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY $<TARGET_FILE_DIR:clpv>)
  target_include_directories(clpv_mpi PRIVATE host)
  target_compile_definitions(clpv_mpi PRIVATE OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX)  # C++ that MPI 3 has given up
  target_link_libraries(clpv_mpi PRIVATE MPI::MPI_C Threads::Threads)
  clpv_warn(clpv_mpi)
  add_dependencies(clpv clpv_mpi)
  # dlopen looks where the program says.
  set_target_properties(clpv PROPERTIES BUILD_RPATH "$ORIGIN"
    INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}/clpv")
  install(TARGETS clpv_mpi LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/clpv)
  set(CLPV_MPIEXEC ${MPIEXEC_EXECUTABLE})
endif()
