// SPDX-License-Identifier: MIT
// Adding to volumes, whatever their layout.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

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

/// Lets launches add to what volumes hold. Buffers are added to in place. An image cannot be both read and written by
/// one launch (OpenCL 1.2): what adds to all its cells writes a spare image, which then changes places with it, and what
/// adds to some cells does so to planes in a buffer, which it is copied to and from. Spares and planes are made when
/// first needed, one for all volumes of a shape and format.
class Accumulator {
 public:
  explicit Accumulator(Session& session) : session_(session) {}

  /// Calls launch(so_far, next): from every cell of `so_far`, which is what `sum` holds, a kernel writes that cell of
  /// `next`, which is what it then holds.
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

  /// Calls launch(cells) with a volume of cells_format() that holds what `sum` does, of which a kernel changes any
  /// cells; `sum` then holds the same.
  template <typename Launch>
  void add_to_cells(Volume& sum, Launch launch) {
    if (sum.format().layout != Layout::image) {
      launch(std::as_const(sum));
      return;
    }
    PlaneStage& stage = planes_of(sum);
    stage.take(sum);
    launch(std::as_const(stage.planes()));
    stage.give(sum);
  }
  static VolumeFormat cells_format(const VolumeFormat& format);

 private:
  Volume& spare_of(const Volume& sum);
  PlaneStage& planes_of(const Volume& sum);

  Session& session_;
  std::vector<std::unique_ptr<Volume>> spares_;
  std::vector<std::unique_ptr<PlaneStage>> planes_;
};

}  // namespace clpv
