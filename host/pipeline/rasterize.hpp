// Rasterises a scene into what a view sees: reflective shadow maps, the camera's G-buffer, shadow maps.
//
// Vertices snap to 1/256 pixel; edges are then exact in integers and follow the top-left rule, so that triangles which
// share an edge leave no pixel out and draw none twice. Of two surfaces at the same depth the triangle that comes
// first in the scene is seen: two runs give the same bytes.
#pragma once

#include "device/session.hpp"
#include "pipeline/scene_buffers.hpp"
#include "pipeline/surface.hpp"

namespace clpv {

class Rasterizer {
 public:
  /// `scene` must stay as it is while the rasteriser lives. Copies handles only.
  Rasterizer(Session& session, const SceneBuffers& scene);

  /// The camera's G-buffer: depth, normal, albedo and, where the surface has it, emission, as `surface.view` sees them.
  /// Back faces are culled unless their material is double-sided. Texture filter: trilinear.
  void rasterize_camera(Surface& surface);

  /// A reflective shadow map of `light`, as `surface.view` sees it: depth, normal, and as colour the flux [W] of each
  /// texel's virtual point light, albedo x irradiance x footprint or albedo x radiant intensity x solid angle (range
  /// and cone included). Both sides of every triangle are lit. In format paper it sets Surface::colour_scale.
  void rasterize_rsm(const ClpvLight& light, Surface& surface);

  /// Depth alone [m], 0 where there is no surface, into view.width x view.height floats. Both sides cast shadows.
  void rasterize_shadow(const ClpvView& view, cl::Buffer& depth);

 private:
  struct Pass;
  void visibility(const ClpvView& view, bool cull_back_faces);
  void bin(const Pass& pass, unsigned first, unsigned count, bool fresh);
  void resolve(const ProgramSource& source, const std::string& kernel, const ClpvLight& light, Surface& surface);
  void require(cl::Buffer& buffer, std::size_t& capacity, std::size_t bytes, const char* what);

  Session& session_;
  SceneBuffers scene_;
};

}  // namespace clpv
