// SPDX-License-Identifier: MIT
// Shapes and number of a frame's volumes, and checks that device and options allow them.
#pragma once

#include <cstddef>
#include <memory>

#include "basis/basis.hpp"
#include "device/session.hpp"
#include "options/render_options.hpp"
#include "volume/volume_format.hpp"

namespace clpv {

VolumeShape light_shape(const RenderOptions& options, const Basis& basis);
VolumeShape geometry_shape(const RenderOptions& options, const Basis& basis);

/// Shape of a volume of swept light; null without a sweep.
std::unique_ptr<Basis> swept_basis(const RenderOptions& options);

/// Returns true if surfaces in the camera's G-buffer block light. A new view then recomputes the RSMs and injected
/// light of every cascade.
bool blocked_by_view(const RenderOptions& options);

/// Number of stored volumes of injected light, and of stored RSMs that follow cascades. It is one per cascade if any
/// frame may need all of them, else one that is recomputed for the current cascade.
int injected_volumes(const RenderOptions& options);

/// Number of stored geometry volumes: one per cascade for scene blockers, else one; 0 without occlusion.
int geometry_volumes(const RenderOptions& options);

/// Returns `options` after checking them. Throws Error(usage) for contradictory options, Error(device) for volumes
/// too large for the device.
const RenderOptions& checked(const Session& session, const RenderOptions& options, const Basis& basis);

}  // namespace clpv
