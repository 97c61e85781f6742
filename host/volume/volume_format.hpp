// SPDX-License-Identifier: MIT
// Memory formats of volumes (layout and storage): device support, lanes, sizes and addresses.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "device/device.hpp"
#include "options/choices.hpp"
#include "support/literals.hpp"

namespace clpv {

/// Shape of a volume: n^3 cells with `coefficients` numbers per cell and channel.
struct VolumeShape {
  int n = 0;
  int coefficients = 0;
  int channels = 3;  ///< light volumes: red, green, blue; geometry volumes: 1
  bool operator==(const VolumeShape&) const = default;
};

std::size_t number_bytes(Storage storage);
std::string format_name(const VolumeFormat& format);  ///< "soa/float"
std::vector<VolumeFormat> all_formats();              ///< every layout with every storage

/// Returns the reason why the device cannot hold volumes of this format: "no 3-D image writes
/// (cl_khr_3d_image_writes)". Nothing if it can.
std::optional<std::string> unsupported(const Device& device, const VolumeFormat& format);
/// The same for a volume of this shape: "an image of 33 x 98 x 2100 texels; at most 2048 x 2048 x
/// 2048".
std::optional<std::string> unsupported(const Device& device, const VolumeFormat& format,
                                       const VolumeShape& shape);
/// Throws Error(device) "unsupported: ..." if either function returns a reason.
void require_supported(const Device& device, const VolumeFormat& format, const VolumeShape& shape);

/// Cells along x that a work-item processes: the device's lanes for buffers, 1 for images.
int lanes_of(const Device& device, const VolumeFormat& format);

/// Adds the literals that kernels/volume/instance.h needs, for `grid` cells along each axis.
void add_volume_literals(Literals& literals, int grid, const VolumeFormat& format, int lanes = 1);

/// Adds the literals that kernels/volume/coefficients.h needs. `number`: type of a coefficient,
/// "realW" for those of W cells (kernels/lanes.h), or "float" for kernels that read one cell at a
/// time.
void add_coefficient_literals(Literals& literals, int coefficients,
                              const std::string& number = "realW");

/// Extent in texels of the image that holds a volume, as in kernels/volume/image.h.
struct ImageExtent {
  std::size_t x, y, z;
};
ImageExtent image_extent(const VolumeShape& shape);
/// Count of numbers of a volume in memory, including borders and padding.
std::size_t stored_numbers(const VolumeFormat& format, const VolumeShape& shape);
std::size_t stored_bytes(const VolumeFormat& format, const VolumeShape& shape);

/// Index of a cell's coefficient among the stored numbers; the host's counterpart of the address
/// functions in kernels/volume/.
std::size_t stored_index(const VolumeFormat& format, const VolumeShape& shape, int channel,
                         int coefficient, int x, int y, int z);

}  // namespace clpv
