// SPDX-License-Identifier: MIT
// Stage `medium`: computes the light that a medium scatters towards the camera
// (kernels/gather/medium.cl).
#pragma once

#include <vector>

#include "basis/basis.hpp"
#include "device/kernel.hpp"
#include "device/session.hpp"
#include "options/stage_options.hpp"
#include "pipeline/gather/gather.hpp"
#include "pipeline/raster/shadow_maps.hpp"
#include "pipeline/raster/surface.hpp"

namespace clpv {

class MediumLight {
 public:
  /// `basis`: of the gathered light, swept_basis(). `medium`: equals ClpvLight::medium of all
  /// lights given to scatter().
  MediumLight(Session& session, const Basis& basis, const ClpvMedium& medium,
              const MediumOptions& options);

  /// Computes the scattered light before `camera`: of `lights`, and of the volumes that `gatherer`
  /// gathered last.
  void scatter(const Surface& camera, const Gatherer& gatherer,
               const std::vector<ShadowedLight>& lights);

  /// Adds the light of the last scatter() to an image of `camera`, which the medium attenuates.
  /// `alone`: replaces the image.
  void add(const Surface& camera, bool alone, Buffer& image);

 private:
  void reserve(const ClpvView& view);

  Session& session_;
  ClpvMedium medium_;
  MediumOptions options_;
  Kernel light_, volumes_, blur_, add_;
  Buffer ends_, scattered_, blurred_;
  std::size_t width_ = 0, height_ = 0;  ///< pixels that the buffers have
};

}  // namespace clpv
