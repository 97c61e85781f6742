#include "pipeline/shade.hpp"

#include <algorithm>

#include "support/error.hpp"

namespace clpv {
namespace {

constexpr std::size_t kLocal = 64;  // pixels of a row a group
constexpr unsigned kLeastShadowTexels = CLPV_SHADOW_TAPS;

ProgramSource source() {
  ProgramSource source;
  source.file = "shade.cl";
  return source;
}

std::size_t pixels_of(const Surface& surface) {
  return static_cast<std::size_t>(surface.view.width) * surface.view.height;
}

void require_fit(const ShadowedLight& shadowed) {
  if (shadowed.views.size() != shadowed.depths.size()) {
    throw Error(ExitCode::run_time, "shade: {} shadow maps for {} views of a light", shadowed.depths.size(),
                shadowed.views.size());
  }
  for (const ClpvView& view : shadowed.views) {
    if (view.width < kLeastShadowTexels || view.height < kLeastShadowTexels) {
      throw Error(ExitCode::run_time, "shade: shadow map of {} x {} texels; at least {} x {} allowed",
                  view.width, view.height, kLeastShadowTexels, kLeastShadowTexels);
    }
  }
}

}  // namespace

Shader::Shader(Session& session)
    : session_(session),
      light_(session.kernel(source(), "light_surfaces")),
      shade_(session.kernel(source(), "shade")) {}

void Shader::light(const Surface& camera, const std::vector<ShadowedLight>& lights) {
  if (camera.format != RsmFormat::float32)
    throw Error(ExitCode::run_time, "shade: the camera's view is not float32");
  if (pixels_of(camera) != pixels_) {
    pixels_ = pixels_of(camera);
    direct_ = session_.buffer(pixels_ * sizeof(cl_float4), "direct light");
  }
  session_.fill_zero(direct_, pixels_ * sizeof(cl_float4));
  for (const ShadowedLight& shadowed : lights) {
    require_fit(shadowed);
    add(camera, shadowed);
  }
}

void Shader::add(const Surface& camera, const ShadowedLight& shadowed) {
  const std::size_t count = shadowed.views.size();
  if (count > reserved_views_) {
    views_ = session_.buffer(count * sizeof(ClpvView), "a light's views");
    reserved_views_ = count;
  }
  session_.write(views_, shadowed.views);
  light_.setArg(0, camera.view);
  light_.setArg(1, camera.depth);
  light_.setArg(2, camera.normal);
  light_.setArg(3, shadowed.light);
  light_.setArg(4, views_);
  light_.setArg(5, static_cast<cl_uint>(count));
  light_.setArg(8, direct_);
  for (std::size_t which = 0; which < std::max<std::size_t>(count, 1); ++which) {
    light_.setArg(6, static_cast<cl_uint>(which));
    light_.setArg(7, count > 0 ? shadowed.depths[which] : cl::Buffer());
    session_.launch(light_, cl::NDRange(camera.view.width, camera.view.height), cl::NDRange(kLocal, 1));
  }
}

void Shader::show(Show what, const Surface& camera, const cl::Buffer& irradiance, cl::Buffer& image) {
  if (pixels_of(camera) != pixels_) throw Error(ExitCode::run_time, "shade: shown before it was lit");
  shade_.setArg(0, static_cast<cl_uint>(what));
  shade_.setArg(1, static_cast<cl_uint>(pixels_));
  shade_.setArg(2, camera.depth);
  shade_.setArg(3, camera.normal);
  shade_.setArg(4, camera.colour);
  shade_.setArg(5, camera.emissive);
  shade_.setArg(6, direct_);
  shade_.setArg(7, irradiance);
  shade_.setArg(8, image);
  session_.launch(shade_, cl::NDRange(pixels_), cl::NDRange(kLocal));
}

}  // namespace clpv
