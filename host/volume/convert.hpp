// SPDX-License-Identifier: MIT
// A volume in an image as planes in a buffer, for stages that change cells in place (kernels/convert.cl).
#pragma once

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// Planes (`soa`, the image's own storage) beside image volumes of one shape.
class PlaneStage {
 public:
  PlaneStage(Session& session, const VolumeShape& shape, Storage storage);

  Volume& planes() { return planes_; }
  void take(const Volume& image);  ///< planes become what the image holds
  void give(Volume& image);        ///< and the other way round

 private:
  void launch(Kernel& kernel, const Volume& from, const Volume& to) const;

  Volume planes_;
  Kernel from_image_, to_image_;
};

}  // namespace clpv
