// SPDX-License-Identifier: MIT
// A volume on the device: N coefficients per cell and channel, in one buffer or one image.
#pragma once

#include <string>
#include <vector>

#include "device/session.hpp"
#include "volume/volume_format.hpp"

namespace clpv {

/// Volume of n^3 cells with zeros around each channel in every layout, so that stencils need no
/// bounds checks. Initially zero.
class Volume {
 public:
  /// Throws Error(device) "unsupported: ..." if the device cannot hold such a volume,
  /// Error(run_time) if its memory does not suffice. `what` names the volume in errors.
  Volume(Session& session, const VolumeShape& shape, const std::string& what,
         const VolumeFormat& format = {});

  /// As many volumes in one buffer, for kernels that write several of them: place() is the index of
  /// a volume's first number in whole(). Any layout but `image`.
  static std::vector<Volume> array(Session& session, int count, const VolumeShape& shape,
                                   const std::string& what, const VolumeFormat& format);
  const Buffer& whole() const { return whole_.exists() ? whole_ : buffer_; }
  std::size_t place() const { return from_ / number_bytes(format_.storage); }

  const VolumeShape& shape() const { return shape_; }
  const VolumeFormat& format() const { return format_; }
  std::size_t bytes() const { return bytes_; }
  /// Kernel argument for a parameter of type CLPV_VOLUME_IN or CLPV_VOLUME_OUT.
  const cl::Memory& memory() const;

  void clear(Session& session);
  /// Clears this volume and those of its array() up to `last`.
  void clear_to(Session& session, const Volume& last);
  /// Copies `from`. Throws Error(run_time) unless it has the same shape and format.
  void copy_from(Session& session, const Volume& from);
  /// Returns all numbers in host order: [channel][coefficient][z][y][x], as in a .npy of shape
  /// (channels, N, z, y, x).
  std::vector<float> read(Session& session) const;
  /// Writes all numbers from host order.
  void write(Session& session, const std::vector<float>& values);

 private:
  void read_stored(Session& session, void* numbers) const;
  void write_stored(Session& session, const void* numbers);

  Volume(const VolumeShape& shape, const VolumeFormat& format);

  VolumeShape shape_;
  VolumeFormat format_;
  std::size_t bytes_ = 0, from_ = 0;
  Buffer whole_;   ///< of an array(), and from_ the volume's first byte
  Buffer buffer_;  ///< empty if the layout is `image`
  Image3D image_;  ///< empty otherwise
};

/// Throws Error(run_time) unless `volume` has the shape and format that the stage `what` is built
/// for.
void require_fit(const Volume& volume, const VolumeShape& shape, const VolumeFormat& format,
                 const char* what);

}  // namespace clpv
