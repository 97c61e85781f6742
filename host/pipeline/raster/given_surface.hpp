// SPDX-License-Identifier: MIT
// Takes a G-buffer that a caller made, as a surface (kernels/raster/given_surface.cl).
#pragma once

#include <CL/opencl.hpp>
#include <optional>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "pipeline/raster/surface.hpp"

namespace clpv {

/// Pixels of a caller on the device, row 0 first.
struct GivenPixels {
  unsigned width = 0, height = 0;
  bool points = false;  ///< places are float4 positions [m], w unused; else float depths [m] along
                        ///< the view's forward axis
  Buffer places;
  Buffer normals;  ///< float4, of any length, w unused
};

class GivenSurface {
 public:
  explicit GivenSurface(Session& session) : session_(session) {}

  /// Returns the surface with unit normals, in format float32 without colours; valid until the next
  /// call. Pixels with a depth that is not positive, a normal of length 0, or a number that is not
  /// finite have no surface.
  const Surface& take(const ClpvView& view, const GivenPixels& pixels);

 private:
  Session& session_;
  std::optional<Kernel> depths_, points_;
  Surface surface_;
  Buffer places_;
};

}  // namespace clpv
