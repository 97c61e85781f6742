// SPDX-License-Identifier: MIT
// A scene on the device: triangles, materials, and textures with their mip chains.
#pragma once

#include <CL/opencl.hpp>
#include <memory>

#include "device/session.hpp"
#include "pipeline/triangle_clusters.hpp"
#include "scene/scene.hpp"

namespace clpv {

struct SceneBuffers {
  Buffer vertices;   ///< ClpvVertex
  Buffer triangles;  ///< ClpvTriangle
  Buffer materials;  ///< ClpvMaterial; textures they lack are the white one
  /// ClpvTexture: CLPV_TEXTURE_LEVELS mip levels a texture, the last one repeated; after the scene's textures a
  /// white one.
  Buffer textures;
  Buffer texels;       ///< 4 bytes a texel: sRGB-encoded RGB, linear alpha
  unsigned white = 0;  ///< that texture
  unsigned vertex_count = 0, triangle_count = 0;
  /// What the scene has at all: textures, vertex colours other than 1, materials that emit, materials with holes.
  bool textured = false, coloured = false, emissive = false, masked = false;
  Bounds bounds;                               ///< of all vertices [m]
  std::shared_ptr<TriangleClusters> clusters;  ///< where triangles are: one for all copies
};

/// Copies a scene to the device. Mip levels are box-filtered in linear light; those of a texture that a
/// masked material uses weigh colour by alpha, so that what is cut away does not tint what stays. Throws
/// Error(bad_input) where an index or a texture's size does not fit, Error(run_time) where memory does not
/// suffice.
SceneBuffers upload_scene(Session& session, const Scene& scene);

/// Brings `buffers`, made of the same scene at another instant, to the one it shows now: its moving parts and its bounds.
/// TriangleClusters::instant() is the version of what they hold.
void upload_moving(Session& session, const Scene& scene, SceneBuffers& buffers);

}  // namespace clpv
