// SPDX-License-Identifier: MIT
// A transport, for one basis, as straight-line OpenCL C: the generated part of kernels/propagate.cl.
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "codegen/linear_code.hpp"
#include "options/choices.hpp"

namespace clpv {

/// One step's form: what the source cells hold and what a cell gains, how many numbers each.
struct StepForm {
  State source = State::coefficients;
  State target = State::coefficients;
  bool blocking = false;
  bool lobes_at_run_time =
      false;  ///< CLPV_ARRIVE gives the fluxes of all faces, as the kernel makes their lobes
  bool functions_at_run_time =
      false;  ///< and takes the functions from the kernel as well: they are `at[face]`
};

/// Generated text and its cost. The text defines, for kernels/propagate.cl, the structs Source, Target and Coefficients
/// with their counts and CLPV_EACH_ macros (cell_macros), and
///   CLPV_EACH_NEIGHBOUR(DO)   DO(i, dx, dy, dz): light arrives from the cell at (x + dx, y + dy, z + dz)
///   CLPV_ARRIVE               declares `gained`, what the cell gains from its neighbours a0, a1, ... ; with blocking
///                             through what lets light pass, t.c0, t.c1, ... (transmit.hpp); with lobes at run time it
///                             sets `through[face]` instead, the flux through each face [W]
///   clpv_expand(sum)          the coefficients of a sum of gains
struct TransportSource {
  std::string text;
  OperationCount arrive;  ///< a cell and channel
  int source_count = 0, target_count = 0, neighbours = 0;
};

/// Of a transport with faces.
TransportSource transport_source(const Basis& basis, const Transport& transport, const StepForm& form);

}  // namespace clpv
