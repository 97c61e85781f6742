// SPDX-License-Identifier: MIT
// Generated text of the kernels that gather (kernels/pack.cl, kernels/gather.cl).
#pragma once

#include <string>

#include "basis/gather_form.hpp"
#include "basis/rotated_lobe.hpp"

namespace clpv {

/// For pack.cl: coefficient_macros of the basis, Gathered, clpv_gathered and CLPV_EACH_PAIR.
std::string pack_source(const Basis& basis, const GatherForm& form);

/// For gather.cl: coefficient_macros, CLPV_EACH_PAIR, clpv_gather_weights(n) and clpv_floor_weights(), in terms of M c
/// where `packed`, else of c. `from_table`: f are read from a table as `lobes` say. `floor`: share of the mean over all
/// normals that E is at least.
std::string gather_source(const GatherForm& form, bool packed, bool from_table, const LobeOptions& lobes,
                          double floor);

/// float8 a record: two numbers of three channels each.
int packed_pairs(const GatherForm& form);

}  // namespace clpv
