// SPDX-License-Identifier: MIT
// Shapes and number of a frame's volumes.
#pragma once

#include <memory>

#include "basis/basis.hpp"
#include "options/render_options.hpp"
#include "volume/volume_format.hpp"

namespace clpv {

VolumeShape light_shape(const RenderOptions& options, const Basis& basis);
VolumeShape geometry_shape(const RenderOptions& options, const Basis& basis);

/// Basis of swept light; null without a sweep.
std::unique_ptr<Basis> swept_basis(const RenderOptions& options);

/// Returns true if surfaces in the camera's G-buffer block light. A new view then recomputes the
/// RSMs and injected light of every cascade.
bool blocked_by_view(const RenderOptions& options);
/// Throws Error(usage) for such options: light without a frame has no G-buffer.
void require_own_blockers(const RenderOptions& options);

/// Number of stored volumes of injected light, and of stored RSMs that follow cascades. It is one
/// per cascade if any frame may need all of them, else one that is recomputed for the current
/// cascade.
int injected_volumes(const RenderOptions& options);

/// Number of stored geometry volumes: one per cascade for scene blockers, else one; 0 without
/// occlusion.
int geometry_volumes(const RenderOptions& options);

}  // namespace clpv
