// SPDX-License-Identifier: MIT
#include "pipeline/gather/medium.hpp"

#include "kernels/shared/pixel_planes.h"

namespace clpv {
namespace {

constexpr int kMediumStep = 2;  // traces one of 2 x 2 pixels

unsigned medium_pixels(unsigned pixels) {
  return (pixels + kMediumStep - 1) / kMediumStep;
}

ProgramSource medium_source(const Basis& basis, const MediumOptions& options) {
  ProgramSource source = with_radiance({"gather/medium.cl"}, basis, options.gather);
  source.literals.integer("CLPV_PLANE_STEP", kMediumStep)
      .integer("CLPV_PLANE_LAYERS", 1)
      .integer("CLPV_LIGHT_STEPS", options.light_steps)
      .integer("CLPV_VOLUME_STEPS", options.volume_steps)
      .flag("CLPV_MEDIUM", true);
  return source;
}

}  // namespace

MediumLight::MediumLight(Session& session, const Basis& basis, const ClpvMedium& medium,
                         const MediumOptions& options)
    : session_(session),
      medium_(medium),
      options_(options),
      light_(session, medium_source(basis, options), "medium_light"),
      volumes_(session, medium_source(basis, options), "medium_volumes"),
      blur_(session, medium_source(basis, options), "medium_blur"),
      add_(session, medium_source(basis, options), "medium_add") {}

void MediumLight::reserve(const ClpvView& view) {
  const std::size_t width = medium_pixels(view.width), height = medium_pixels(view.height),
                    plane = pixel_plane_size(width, height);
  if (width == width_ && height == height_) return;
  width_ = height_ = 0;  // until memory suffices
  session_.reserve(ends_, plane * sizeof(cl_float), "ends of rays in the medium");
  session_.reserve(scattered_, 3 * plane * sizeof(cl_float), "light scattered by the medium");
  session_.reserve(blurred_, 3 * plane * sizeof(cl_float), "blurred light of the medium");
  session_.fill_zero(ends_, plane * sizeof(cl_float));  // borders stay 0
  session_.fill_zero(scattered_, 3 * plane * sizeof(cl_float));
  session_.fill_zero(blurred_, 3 * plane * sizeof(cl_float));
  width_ = width, height_ = height;
}

void MediumLight::scatter(const Surface& camera, const Gatherer& gatherer,
                          const std::vector<ShadowedLight>& lights) {
  const ClpvView& view = camera.view;
  reserve(view);
  const cl::NDRange rows(items_along(session_, medium_pixels(view.width)),
                         medium_pixels(view.height));
  volumes_.set(view, camera.depth, medium_, ends_, scattered_);
  gatherer.add_radiance(volumes_);
  volumes_.launch(rows, pixel_group(session_));
  for_each_shadow_map(lights, [&](const ShadowedLight& shadowed, cl_uint which) {
    light_.set(view, camera.depth);
    add_shadow_map(light_, shadowed, which).add(scattered_).launch(rows, pixel_group(session_));
  });
  blur_.set(view, ends_, scattered_, blurred_).launch(rows, pixel_group(session_));
}

void MediumLight::add(const Surface& camera, bool alone, Buffer& image) {
  add_.set(camera.view, camera.depth, medium_, ends_, blurred_, cl_uint{alone}, image)
      .launch(items_of(session_, camera.view), pixel_group(session_));
}

}  // namespace clpv
