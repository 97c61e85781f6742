// SPDX-License-Identifier: MIT
#include "pipeline/raster/given_surface.hpp"

namespace clpv {
namespace {

constexpr std::size_t kPixelsPerGroup = 64;

}  // namespace

const Surface& GivenSurface::take(const ClpvView& view, const GivenPixels& pixels) {
  const std::size_t count = std::size_t{pixels.width} * pixels.height;
  std::optional<Kernel>& kernel = pixels.points ? points_ : depths_;
  if (!kernel) {
    ProgramSource source{"raster/given_surface.cl"};
    source.literals.flag("CLPV_POINTS", pixels.points);
    kernel.emplace(session_, source, "given_surface");
  }
  surface_.view = view;
  surface_.depth = surface_.position = {};
  session_.reserve(places_, count * (pixels.points ? sizeof(cl_float4) : sizeof(cl_float)),
                   "places of a given surface");
  session_.reserve(surface_.normal, count * sizeof(cl_float4), "normals of a given surface");
  (pixels.points ? surface_.position : surface_.depth) = places_;
  kernel->set(static_cast<cl_uint>(count), pixels.places, pixels.normals, places_, surface_.normal)
      .launch(cl::NDRange(count), cl::NDRange(kPixelsPerGroup));
  return surface_;
}

}  // namespace clpv
