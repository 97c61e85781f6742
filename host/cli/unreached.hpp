// SPDX-License-Identifier: MIT
// Surfaces that no cascade reaches.
#pragma once

#include <string>

#include "device/session.hpp"
#include "pipeline/frame/frame.hpp"

namespace clpv {

/// Returns the share of the visible surfaces' pixels that no cascade of the last render reaches:
/// they have no indirect light. 0 without a surface.
double unreached_share(Session& session, const Frame& frame);

/// Warns above 0.1 %.
void warn_of_unreached(Session& session, const Frame& frame, const std::string& camera);

}  // namespace clpv
