// SPDX-License-Identifier: MIT
// Generated text of the kernels that send light back (kernels/bounce.cl).
#pragma once

#include <string>

namespace clpv {

/// Coefficients of six sides, Swept of 24 bins, clpv_arriving and clpv_leaving.
std::string bounce_source_text();

/// Sides, and Sides clpv_arriving(Swept), for sweep_collect.cl.
std::string arriving_source_text();

}  // namespace clpv
