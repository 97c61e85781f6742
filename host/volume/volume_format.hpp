// SPDX-License-Identifier: MIT
// How a volume lies in memory: layout and storage; what a device lacks for either, and what a cell costs to reach.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "device/device.hpp"
#include "device/literals.hpp"
#include "options/choices.hpp"

namespace clpv {

/// Shape of a volume. `n` samples along each axis, `coefficients` a sample and channel.
struct VolumeShape {
  int n = 0;
  int coefficients = 0;
  int channels = 3;  ///< light volumes: red, green, blue; geometry volumes: 1
  bool operator==(const VolumeShape&) const = default;
};

std::size_t number_bytes(Storage storage);
std::string format_name(const VolumeFormat& format);  ///< "soa/float"
std::vector<VolumeFormat> all_formats();

/// Why the device cannot hold volumes of this format at all: "no 3-D image writes (cl_khr_3d_image_writes)".
std::optional<std::string> unsupported(const Device& device, const VolumeFormat& format);
/// The same of a volume of this shape: "an image of 33 x 98 x 2100 texels; at most 2048 along z".
std::optional<std::string> unsupported(const Device& device, const VolumeFormat& format,
                                       const VolumeShape& shape);
/// Throws Error(device) "unsupported: ..." where one of them gives a reason.
void require_supported(const Device& device, const VolumeFormat& format, const VolumeShape& shape);

/// Cells along x that a work-item of a stencil should serve: 8 on CPU devices where they do not vectorise over
/// work-items, which is all but soa/float; else 1.
int preferred_lanes(const Device& device, const VolumeFormat& format);

/// The same where work-items do not vectorise whatever the format: 8 in buffers on CPU devices.
int preferred_row_lanes(const Device& device, const VolumeFormat& format);

/// What kernels/volume/instance.h wants to know.
void add_format_literals(Literals& literals, const VolumeFormat& format, int lanes = 1);

/// Loads, or stores, that one cell of one channel takes: texels of images, numbers of buffers.
int accesses_per_cell(const VolumeFormat& format, int coefficients);
/// Bytes these move.
std::size_t bytes_per_cell(const VolumeFormat& format, int coefficients);

/// Texels of the image that holds a volume: kernels/volume/image.h.
struct ImageExtent {
  std::size_t x, y, z;
};
ImageExtent image_extent(const VolumeShape& shape);
/// Numbers a volume takes in memory, borders and padding included.
std::size_t stored_numbers(const VolumeFormat& format, const VolumeShape& shape);
std::size_t stored_bytes(const VolumeFormat& format, const VolumeShape& shape);

/// Where a coefficient of a sample is among the stored numbers; the one mirror of the address functions in
/// kernels/volume/.
std::size_t stored_index(const VolumeFormat& format, const VolumeShape& shape, int channel, int coefficient,
                         int x, int y, int z);

}  // namespace clpv
