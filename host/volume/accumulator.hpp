// SPDX-License-Identifier: MIT
// Adds to volumes of any layout, including images, which a launch cannot both read and write.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// A buffer volume of layout `soa` that image volumes of one shape are copied to and from.
class PlaneStage {
 public:
  PlaneStage(Session& session, const VolumeShape& shape, Storage storage);

  Volume& planes() { return planes_; }
  void load(const Volume& image);  ///< copies the image to the planes
  void store(Volume& image);       ///< copies the planes to the image

 private:
  void launch(Kernel& kernel, const Volume& from, const Volume& to) const;

  Volume planes_;
  Kernel from_image_, to_image_;
};

/// Lets launches add to volumes. Buffers are updated in place. OpenCL 1.2 cannot read and write an
/// image in one launch. add() therefore writes a spare image and swaps the two; add_to_cells()
/// copies the image to a PlaneStage and back. Spares and planes are allocated on first use and
/// shared by all volumes of a shape and format.
class Accumulator {
 public:
  explicit Accumulator(Session& session) : session_(session) {}

  /// Calls launch(current, next), whose kernel reads every cell of `current` = `sum` and writes
  /// that cell of `next`. `sum` then holds `next`.
  template <typename Launch>
  void add(Volume& sum, Launch launch) {
    if (sum.format().layout != Layout::image) {
      launch(std::as_const(sum), std::as_const(sum));
      return;
    }
    Volume& spare = spare_of(sum);
    launch(std::as_const(sum), std::as_const(spare));
    std::swap(sum, spare);
  }

  /// Calls launch(cells) with a copy of `sum` in cells_format(), of which a kernel may change any
  /// cells. `sum` then holds the result.
  template <typename Launch>
  void add_to_cells(Volume& sum, Launch launch) {
    if (sum.format().layout != Layout::image) {
      launch(std::as_const(sum));
      return;
    }
    PlaneStage& stage = planes_of(sum);
    stage.load(sum);
    launch(std::as_const(stage.planes()));
    stage.store(sum);
  }
  /// Format of the volume that add_to_cells() passes to its launch.
  static VolumeFormat cells_format(const VolumeFormat& format);

 private:
  Volume& spare_of(const Volume& sum);
  PlaneStage& planes_of(const Volume& sum);

  Session& session_;
  std::vector<std::unique_ptr<Volume>> spares_;
  std::vector<std::unique_ptr<PlaneStage>> planes_;
};

}  // namespace clpv
