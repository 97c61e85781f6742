// SPDX-License-Identifier: MIT
// Generates the text of the gathering kernels (kernels/gather/pack.cl, kernels/gather/gather.cl).
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/rotated_lobe.hpp"
#include "basis/transport.hpp"

namespace clpv {

/// For gather.cl: Coefficients of floats, the basis's functions, CLPV_FACE_TRANSPORT (0: swept
/// light) and CLPV_FROM_TABLE: functions come from the table that `lobes` describes.
std::string gather_source(const Basis& basis, TransportKind transport, const LobeOptions& lobes,
                          bool from_table);

/// For radiance.h: Coefficients of floats, and the functions of the basis of swept light.
std::string radiance_source(const Basis& basis);

/// Number of float8 in a record, each with two coefficients of three channels.
int packed_pairs(const Basis& basis);

}  // namespace clpv
