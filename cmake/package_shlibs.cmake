# SPDX-License-Identifier: MIT
# cpack runs this before dpkg-shlibdeps, which then finds no package for the library of the MPI module: the program loads that
# module only for several ranks.
file(WRITE ${CPACK_TEMPORARY_DIRECTORY}/debian/shlibs.local "libmpi 40\n")
