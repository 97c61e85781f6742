// SPDX-License-Identifier: MIT
// Surfaces visible in a view (an RSM or the camera's G-buffer), on the device and read back; or
// points without a view.
#pragma once

#include <CL/opencl.hpp>
#include <glm/glm.hpp>
#include <vector>

#include "device/session.hpp"
#include "image/image.hpp"
#include "kernels/shared/raster.h"
#include "kernels/shared/view.h"
#include "options/choices.hpp"

namespace clpv {

/// One value per pixel, row 0 first, on the device. Depth [m] is along the view's forward axis; 0
/// means no surface. `format` paper stores normal and colour in 4 bytes per pixel; float32 in 4
/// floats (kernels/raster/surface.h).
struct Surface {
  ClpvView view{};
  cl_uint first = 0;  ///< index of its first pixel in the buffers
  RsmFormat format = RsmFormat::float32;
  float colour_scale = 1;  ///< value of a stored 1 of `colour` in format paper
  Buffer depth;            ///< float
  Buffer normal;           ///< unit length, world space, towards the viewer; 0 without a surface
  Buffer colour;           ///< camera: albedo; light: flux of the virtual point light [W]
  Buffer emissive;         ///< camera only: float4, emitted radiance [W/m^2/sr]
  /// Points without a view: float4 [m], instead of depth. Only the size of `view` is used. For
  /// gathering and the near field, w is 1, or 0 without a surface.
  Buffer position;

  /// Kernels read positions with CLPV_POINTS 1, depths with 0.
  bool points() const { return position.exists(); }
  const Buffer& places() const { return points() ? position : depth; }
};

/// Allocates a surface of the view's size for a rasteriser; contents are undefined.
/// `with_emissive`: allocates Surface::emissive. `count`: surfaces for which its buffers have room.
Surface make_surface(Session& session, const ClpvView& view, RsmFormat format, bool with_emissive,
                     int count = 1);

/// Reads a surface and decodes paper format. Normals are 0 without a surface. The emissive field is
/// empty without Surface::emissive.
SurfaceImage read_surface(Session& session, const Surface& surface);
/// Uploads `image`. Empty fields stay undefined on the device; emissive is allocated only if not
/// empty.
Surface upload_surface(Session& session, const SurfaceImage& image,
                       RsmFormat format = RsmFormat::float32, float colour_scale = 1);

inline unsigned tiles_along(unsigned pixels) {
  return (pixels + CLPV_TILE - 1) / CLPV_TILE;
}
/// Number of work-items for a row of pixels.
inline unsigned items_along(const Session& session, unsigned pixels) {
  return (pixels + session.device().lanes - 1) / session.device().lanes;
}
inline cl::NDRange items_of(const Session& session, const ClpvView& view) {
  return {items_along(session, view.width), view.height};
}
/// Work-group of these work-items. Rows differ in work: with eight lanes, small groups balance it
/// between cores.
inline cl::NDRange pixel_group(const Session& session) {
  return {8, session.device().lanes == 8 ? 1u : 8u};
}

}  // namespace clpv
