// SPDX-License-Identifier: MIT
// A volume on the device: N coefficients a cell and channel, in one buffer or one image.
#pragma once

#include <string>
#include <vector>

#include "device/session.hpp"
#include "volume/volume_format.hpp"

namespace clpv {

/// Every layout has zeros round the samples of each channel, so that neighbours need no bounds checks. Made
/// zero.
class Volume {
 public:
  /// Throws Error(device) "unsupported: ..." where the device cannot hold such a volume, Error(run_time) where its
  /// memory does not suffice.
  Volume(Session& session, const VolumeShape& shape, const std::string& what,
         const VolumeFormat& format = {});

  const VolumeShape& shape() const { return shape_; }
  const VolumeFormat& format() const { return format_; }
  std::size_t bytes() const { return bytes_; }
  /// For a kernel's argument of type CLPV_VOLUME_IN or CLPV_VOLUME_OUT.
  const cl::Memory& memory() const;

  void clear(Session& session);
  /// `from`: the same shape and format.
  void copy_from(Session& session, const Volume& from);
  /// Host order: [channel][coefficient][z][y][x], as in a .npy of shape (channels, N, z, y, x).
  std::vector<float> read(Session& session) const;
  void write(Session& session, const std::vector<float>& values);

 private:
  void read_stored(Session& session, void* numbers) const;
  void write_stored(Session& session, const void* numbers);

  VolumeShape shape_;
  VolumeFormat format_;
  std::size_t bytes_ = 0;
  Buffer buffer_;  ///< one of the two is none
  Image3D image_;
};

/// Throws Error(run_time) where `volume` is of another shape or format than `what` is made for.
void require_fit(const Volume& volume, const VolumeShape& shape, const VolumeFormat& format,
                 const char* what);

}  // namespace clpv
