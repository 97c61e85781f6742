// SPDX-License-Identifier: MIT
// A scene on the device: triangles, materials, and textures with their mip chains.
#pragma once

#include <CL/opencl.hpp>
#include <memory>

#include "device/session.hpp"
#include "pipeline/raster/triangle_clusters.hpp"
#include "scene/scene.hpp"

namespace clpv {

struct SceneBuffers {
  Buffer vertices;   ///< ClpvVertex
  Buffer triangles;  ///< ClpvTriangle
  Buffer materials;  ///< ClpvMaterial; missing textures refer to the white one
  /// ClpvTexture: CLPV_TEXTURE_LEVELS mip levels per texture, the last one repeated. A white
  /// texture follows those of the scene.
  Buffer textures;
  Buffer texels;       ///< 4 bytes a texel: sRGB-encoded RGB, linear alpha
  unsigned white = 0;  ///< index of the white texture
  unsigned triangle_count = 0;
  /// Features of the scene: textures, vertex colours other than 1, emissive materials, masked
  /// materials.
  bool textured = false, coloured = false, emissive = false, masked = false, medium = false;
  Bounds bounds;                               ///< bounds of all vertices [m]
  std::shared_ptr<TriangleClusters> clusters;  ///< bounds of the triangles; shared by all copies
};

/// Copies a scene to the device. Mip levels are box-filtered in linear light. For masked materials
/// they weight colour by alpha, so that transparent texels do not tint opaque ones. Throws
/// Error(bad_input) for an invalid index or texture size, Error(run_time) if memory does not
/// suffice.
SceneBuffers upload_scene(Session& session, const SceneData& scene);

/// Updates the moving parts and bounds of `buffers` to the scene's current time. `buffers` must
/// hold the same scene. TriangleClusters::instant() is the version of their contents.
void upload_moving(Session& session, const SceneData& scene, SceneBuffers& buffers);

}  // namespace clpv
