// SPDX-License-Identifier: MIT
// The program's basis: N functions b_i on the unit sphere, f(w) = sum_i c_i b_i(w).
//
//   basis_functions(x, y, z)     b_i(w) of the unit vector w = (x, y, z)
//   cosine_integrals(x, y, z)    alpha_i(n) = Int b_i(w) max(0, w . n) dw of the unit vector n
//   functions_at(x, y, z)        b_i(w), from a look-up table where the program has one
//
// From the host (Basis::add_literals): CLPV_BASIS, one of three names below, and the tables
// that its header lists; CLPV_FROM_TABLE 1: functions come from the table of G (table.h). With it,
// the table is the last argument: CLPV_AND_G ends parameter lists, CLPV_PASS_G calls.
#pragma once

#include "volume/coefficients.h"

#define CLPV_HARMONICS 1
#define CLPV_RADIAL 2
#define CLPV_BINS 3

#if CLPV_BASIS == CLPV_HARMONICS
#include "basis/harmonics.h"
#elif CLPV_BASIS == CLPV_RADIAL
#include "basis/radial.h"
#elif CLPV_BASIS == CLPV_BINS
#include "basis/bins.h"
#endif

#if CLPV_FROM_TABLE
#include "basis/table.h"
#define CLPV_AND_G , CLPV_TABLE poisson_table
#define CLPV_PASS_G , poisson_table
#define functions_at table_functions
#else
#define CLPV_AND_G
#define CLPV_PASS_G
#define functions_at basis_functions
#endif
