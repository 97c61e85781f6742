// SPDX-License-Identifier: MIT
// The volumes of a frame: their shapes, how many there are, and whether device and options allow them.
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

/// Of what a sweep leaves; null without one.
std::unique_ptr<Basis> swept_basis(const RenderOptions& options);

/// Whether what the camera sees blocks: a frame of another view then needs the RSMs and the injected light of every
/// cascade again.
bool blocked_by_view(const RenderOptions& options);

/// Volumes of injected light, and RSMs of a light that follow cascades, a frame keeps: one a cascade where every frame may
/// need all of them; else one, made for whichever cascade is lit anew.
int injected_volumes(const RenderOptions& options);

/// Geometry volumes that a frame keeps: what the scene blocks, a cascade; else one; none without occlusion.
int geometry_volumes(const RenderOptions& options);

/// `options` themselves. Throws Error(usage) for those that contradict each other, Error(device) for volumes that the device
/// cannot hold at all.
const RenderOptions& checked(const Session& session, const RenderOptions& options, const Basis& basis);

}  // namespace clpv
