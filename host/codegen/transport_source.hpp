// SPDX-License-Identifier: MIT
// Generates the transport of a propagation step for one basis as straight-line OpenCL C (kernels/steps/propagate.cl).
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "codegen/linear_code.hpp"
#include "options/choices.hpp"

namespace clpv {

/// Variant of a step: the states of source and target cells, blocking, and work done at run time.
struct StepForm {
  State source = State::coefficients;
  State target = State::coefficients;
  bool blocking = false;
  bool lobes_at_run_time =
      false;  ///< CLPV_ARRIVE computes the fluxes of all faces; the kernel computes their lobes
  bool functions_at_run_time = false;  ///< CLPV_ARRIVE reads the basis functions `at[face]` from the kernel
};

/// Generated text and its operations. For kernels/steps/propagate.cl the text defines the structs Source, Target and
/// Coefficients with their counts and CLPV_EACH_ macros (cell_macros), and
///   CLPV_EACH_NEIGHBOUR(DO)   DO(i, dx, dy, dz) for each neighbour (x + dx, y + dy, z + dz) that light comes from
///   CLPV_ARRIVE               declares `gained`, the light that the cell gains from its neighbours a0, a1, ...; with
///                             blocking times the transmittance t.c0, t.c1, ... (transmittance_source.hpp); with lobes
///                             at run time it sets `through[face]` instead, the flux through each face [W]
///   expand_fluxes(sum)          coefficients of a sum of gains
struct TransportSource {
  std::string text;
  OperationCount arrive;  ///< per cell and channel
  int source_count = 0, target_count = 0, neighbours = 0;
};

/// For a transport with faces.
TransportSource transport_source(const Basis& basis, const Transport& transport, const StepForm& form);

}  // namespace clpv
