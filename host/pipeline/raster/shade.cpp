// SPDX-License-Identifier: MIT
#include "pipeline/raster/shade.hpp"

#include "pipeline/raster/surface.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr std::size_t kShadeGroup = 64;  // pixels per work-group
constexpr unsigned kMinShadowTexels = CLPV_SHADOW_TAPS;

ProgramSource shade_source(bool medium) {
  ProgramSource source{"raster/shade.cl"};
  if (medium) source.literals.flag("CLPV_MEDIUM", true);
  return source;
}

std::size_t pixels_of(const Surface& surface) {
  return static_cast<std::size_t>(surface.view.width) * surface.view.height;
}

void require_fit(const ShadowedLight& shadowed) {
  if (shadowed.views.size() != shadowed.depths.size()) {
    throw Error(ExitCode::run_time, "shade: {} shadow maps for {} views of a light",
                shadowed.depths.size(), shadowed.views.size());
  }
  for (const ClpvView& view : shadowed.views) {
    if (view.width < kMinShadowTexels || view.height < kMinShadowTexels) {
      throw Error(ExitCode::run_time,
                  "shade: shadow map of {} x {} texels; at least {} x {} allowed", view.width,
                  view.height, kMinShadowTexels, kMinShadowTexels);
    }
  }
}

}  // namespace

Shader::Shader(Session& session, bool medium)
    : session_(session),
      light_(session, shade_source(medium), "light_surfaces"),
      shade_(session, shade_source(medium), "shade") {}

void Shader::light(const Surface& camera, const std::vector<ShadowedLight>& lights) {
  if (camera.format != RsmFormat::float32)
    throw Error(ExitCode::run_time, "shade: the camera's view is not float32");
  session_.reserve(direct_, pixels_of(camera) * sizeof(cl_float4), "direct light");
  pixels_ = pixels_of(camera);
  if (lights.empty()) session_.fill_zero(direct_, pixels_ * sizeof(cl_float4));
  for (const ShadowedLight& shadowed : lights) require_fit(shadowed);
  cl_uint fresh = 1;
  for_each_shadow_map(lights, [&](const ShadowedLight& shadowed, cl_uint which) {
    light_.set(camera.view, camera.depth, camera.normal);
    add_shadow_map(light_, shadowed, which)
        .add(fresh, direct_)
        .launch(items_of(session_, camera.view), pixel_group(session_));
    fresh = 0;
  });
}

void Shader::show(Show what, const Surface& camera, const Buffer& irradiance, Buffer& image) {
  if (pixels_of(camera) != pixels_)
    throw Error(ExitCode::run_time, "shade: shown before it was lit");
  shade_
      .set(static_cast<cl_uint>(what), static_cast<cl_uint>(pixels_), camera.depth, camera.normal,
           camera.colour, camera.emissive, direct_, irradiance, image)
      .launch(cl::NDRange(pixels_), cl::NDRange(kShadeGroup));
}

}  // namespace clpv
