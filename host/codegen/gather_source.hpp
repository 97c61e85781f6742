// SPDX-License-Identifier: MIT
// Generated text of the kernels that gather (kernels/pack.cl, kernels/gather.cl).
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/rotated_lobe.hpp"
#include "basis/transport.hpp"

namespace clpv {

/// For pack.cl: coefficient_macros of the basis and CLPV_EACH_PAIR.
std::string pack_source(const Basis& basis);

/// For gather.cl: coefficient_macros, CLPV_EACH_PAIR and clpv_gather_weights(n). `from_table`: b is read from a table as
/// `lobes` say.
std::string gather_source(const Basis& basis, TransportKind transport, const LobeOptions& lobes,
                          bool from_table);

/// float8 a record: two numbers of three channels each.
int packed_pairs(const Basis& basis);

}  // namespace clpv
