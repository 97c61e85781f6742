// SPDX-License-Identifier: MIT
// What a view sees: an RSM or the camera's G-buffer, on the device and read back; or points that none sees.
#pragma once

#include <CL/opencl.hpp>
#include <glm/glm.hpp>
#include <vector>

#include "device/session.hpp"
#include "image/surface_image.hpp"
#include "kernels/shared/raster.h"
#include "kernels/shared/view.h"
#include "options/choices.hpp"

namespace clpv {

/// One value a pixel, row 0 first, on the device. Depth [m] along the view's forward axis, 0: no surface
/// there. `format` paper: normal and colour hold 4 bytes a pixel; float32: 4 floats (kernels/surface.h).
struct Surface {
  ClpvView view{};
  RsmFormat format = RsmFormat::float32;
  float colour_scale = 1;  ///< what a stored 1 of `colour` means in format paper
  Buffer depth;            ///< float
  Buffer normal;           ///< unit, world space, turned towards the viewer; 0 where there is no surface
  Buffer colour;           ///< camera: albedo; light: flux of the virtual point light [W]
  Buffer emissive;         ///< camera only: float4, emitted radiance [W/m^2/sr]
  /// Points that no view sees (Emitter): float4 [m], in place of depth; of `view` the size alone counts.
  Buffer position;
};

/// A surface of the view's size for a rasteriser to fill; contents undefined. `with_emissive`: has
/// Surface::emissive.
Surface make_surface(Session& session, const ClpvView& view, RsmFormat format, bool with_emissive);

/// Paper format decoded; normals are 0 where there is no surface. Without Surface::emissive that field stays
/// empty.
SurfaceImage read_surface(Session& session, const Surface& surface);
/// Fields of `image` that are empty stay undefined on the device; emissive is made where it is not empty.
Surface upload_surface(Session& session, const SurfaceImage& image, RsmFormat format = RsmFormat::float32,
                       float colour_scale = 1);

inline unsigned tiles_along(unsigned pixels) {
  return (pixels + CLPV_TILE - 1) / CLPV_TILE;
}
inline cl::NDRange rows_of_tiles(const ClpvView& view) {
  return {tiles_along(view.width), view.height};
}
/// Rows differ in work: small groups even it out between cores.
inline const cl::NDRange kTileRow(8, 1);

}  // namespace clpv
