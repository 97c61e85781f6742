// SPDX-License-Identifier: MIT
// Generates the text of the gathering kernels (kernels/gather/pack.cl, kernels/gather/gather.cl).
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/rotated_lobe.hpp"
#include "basis/transport.hpp"

namespace clpv {

/// For pack.cl: coefficient_macros of the basis and CLPV_EACH_PAIR.
std::string pack_source(const Basis& basis);

/// For gather.cl: coefficient_macros, CLPV_EACH_PAIR and gather_weights(n). `from_table`: reads b from the table
/// that `lobes` describes.
std::string gather_source(const Basis& basis, TransportKind transport, const LobeOptions& lobes,
                          bool from_table);

/// For kernels/gather/radiance.h: coefficient_macros, CLPV_EACH_PAIR, and the functions of the basis of swept light.
std::string radiance_source(const Basis& basis);

/// Number of float8 in a record, each with two coefficients of three channels.
int packed_pairs(const Basis& basis);

}  // namespace clpv
