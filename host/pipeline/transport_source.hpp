// A transport, for one basis, as straight-line OpenCL C: the generated part of kernels/propagate.cl.
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "pipeline/linear_code.hpp"

namespace clpv {

/// What travels from cell to cell. `coefficients`: the N of the basis. `fluxes`: what a face transport's cell
/// received through its six faces, whatever N is; the N coefficients come back at the end (MATH section 3,
/// 'Six fluxes').
enum class State { coefficients, fluxes };

/// One step's form: what the source cells hold and what a cell gains, how many numbers each.
struct StepForm {
  State source = State::coefficients;
  State target = State::coefficients;
  bool blocking = false;
};

/// Generated text and its cost. The text defines, for kernels/propagate.cl,
///   CLPV_SOURCE_N, CLPV_EACH_SOURCE(DO), CLPV_TARGET_N, CLPV_EACH_TARGET(DO), CLPV_N,
///   CLPV_EACH_COEFFICIENT(DO) CLPV_EACH_NEIGHBOUR(DO)   DO(i, dx, dy, dz): light arrives from the cell at (x
///   + dx, y + dy, z + dz) CLPV_NEIGHBOUR_ARGUMENTS  a0, a1, ... : what those cells hold static Transmittance
///   clpv_transmittance(g0 .. g7)         with blocking: 1 - B of each way, from the 8 corners static Target
///   clpv_arrive(a0, ..., [Transmittance t])     what the cell gains static Coefficients clpv_expand(Target
///   sum)               the coefficients of a sum of gains
struct TransportSource {
  std::string text;
  OperationCount arrive;         ///< a cell and channel
  OperationCount transmittance;  ///< a cell
  int source_count = 0, target_count = 0, neighbours = 0;
};

/// Throws Error(usage) for State::fluxes with a transport that has no faces.
TransportSource transport_source(const Basis& basis, const Transport& transport, const StepForm& form);

}  // namespace clpv
