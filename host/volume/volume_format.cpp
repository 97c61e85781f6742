// SPDX-License-Identifier: MIT
#include "volume/volume_format.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "support/error.hpp"
#include "support/named_enum.hpp"

namespace clpv {
namespace {

constexpr int kTile = 8;   // cells of a block of layout `tiled`
constexpr int kTexel = 4;  // coefficients of a texel
constexpr int kMaxLanes = 8;

/// Beside kNames<Layout>.
constexpr const char* kLayoutLiterals[] = {"CLPV_IMAGE", "CLPV_AOS", "CLPV_SOA", "CLPV_TILED"};
static_assert(std::size(kLayoutLiterals) == kNames<Layout>.size());

std::size_t size(int value) {
  return value;
}

std::size_t blocks_per_row(const VolumeShape& shape) {
  return size((shape.n + kTile - 1) / kTile + 1);
}

/// Cells from one row to the next, so that 8 lanes never reach the next row.
std::size_t row_pitch(const VolumeShape& shape) {
  return size((shape.n + kMaxLanes - 1) / kMaxLanes * kMaxLanes + 2);
}

/// Cells of a channel, including its border.
std::size_t bordered_cells(const VolumeShape& shape) {
  return size(shape.n + 2) * size(shape.n + 2) * row_pitch(shape);
}

}  // namespace

std::size_t number_bytes(Storage storage) {
  return storage == Storage::float16 ? 2 : 4;
}

std::string format_name(const VolumeFormat& format) {
  return fmt::format("{}/{}", name_of(format.layout), name_of(format.storage));
}

std::vector<VolumeFormat> all_formats() {
  std::vector<VolumeFormat> formats;
  for (const Layout layout : values_of<Layout>()) {
    for (const Storage storage : values_of<Storage>()) formats.push_back({layout, storage});
  }
  return formats;
}

std::optional<std::string> unsupported(const Device& device, const VolumeFormat& format) {
  if (format.layout != Layout::image) return std::nullopt;
  if (!device.images) return "no images";
  if (!device.image3d_writes) return "no 3-D image writes (cl_khr_3d_image_writes)";
  return std::nullopt;
}

std::optional<std::string> unsupported(const Device& device, const VolumeFormat& format,
                                       const VolumeShape& shape) {
  if (const auto reason = unsupported(device, format)) return reason;
  if (format.layout == Layout::image) {
    const ImageExtent extent = image_extent(shape);
    const std::size_t max_x = device.handle.getInfo<CL_DEVICE_IMAGE3D_MAX_WIDTH>(),
                      max_y = device.handle.getInfo<CL_DEVICE_IMAGE3D_MAX_HEIGHT>(),
                      max_z = device.handle.getInfo<CL_DEVICE_IMAGE3D_MAX_DEPTH>();
    if (extent.x <= max_x && extent.y <= max_y && extent.z <= max_z) return std::nullopt;
    return fmt::format("an image of {} x {} x {} texels; at most {} x {} x {}", extent.x, extent.y,
                       extent.z, max_x, max_y, max_z);
  }
  const std::size_t limit = std::numeric_limits<std::int32_t>::max(),
                    numbers = stored_numbers(format, shape);
  if (numbers > limit) {
    const double share = static_cast<double>(limit) / static_cast<double>(numbers);
    return fmt::format("a volume of {} numbers at grid {}; kernels address at most {}: grid {}",
                       numbers, shape.n, limit, static_cast<int>(shape.n * std::cbrt(share)));
  }
  return std::nullopt;
}

void require_supported(const Device& device, const VolumeFormat& format, const VolumeShape& shape) {
  if (const auto reason = unsupported(device, format, shape)) {
    throw Error(ExitCode::device, "{} on {} is unsupported: {}", format_name(format), device.name,
                *reason);
  }
}

int lanes_of(const Device& device, const VolumeFormat& format) {
  return format.layout == Layout::image ? 1 : device.lanes;
}

void add_volume_literals(Literals& literals, int grid, const VolumeFormat& format, int lanes) {
  literals.integer("CLPV_GRID", grid)
      .word("CLPV_LAYOUT", kLayoutLiterals[static_cast<std::size_t>(format.layout)])
      .flag("CLPV_STORAGE_HALF", format.storage == Storage::float16)
      .integer("CLPV_W", lanes);
}

void add_coefficient_literals(Literals& literals, int coefficients, const std::string& number) {
  literals.integer("CLPV_N", coefficients).word("CLPV_COEFFICIENT", number);
}

ImageExtent image_extent(const VolumeShape& shape) {
  const auto stacked = [&](int slabs) { return size(slabs) * size(shape.n + 1) - 1; };
  return {size(shape.n), stacked(shape.channels),
          stacked((shape.coefficients + kTexel - 1) / kTexel)};
}

std::size_t stored_numbers(const VolumeFormat& format, const VolumeShape& shape) {
  const std::size_t n = size(shape.coefficients), channels = size(shape.channels);
  // Buffers are zeroed in units of 4 bytes, so the number of halves is even.
  const auto padded = [](std::size_t numbers) { return (numbers + 1) / 2 * 2; };
  switch (format.layout) {
    case Layout::image: {
      const ImageExtent extent = image_extent(shape);
      return extent.x * extent.y * extent.z * kTexel;
    }
    case Layout::tiled:
      return (channels * size(shape.n + 2) * size(shape.n + 2) * blocks_per_row(shape) + 1) *
             kTile * n;
    case Layout::aos:
      return padded(channels * bordered_cells(shape) * n);
    case Layout::soa:
      break;
  }
  return padded(channels * n * bordered_cells(shape));
}

std::size_t stored_bytes(const VolumeFormat& format, const VolumeShape& shape) {
  return stored_numbers(format, shape) * number_bytes(format.storage);
}

std::size_t stored_index(const VolumeFormat& format, const VolumeShape& shape, int channel,
                         int coefficient, int x, int y, int z) {
  const std::size_t n = size(shape.coefficients), i = size(coefficient), rows = size(shape.n + 2);
  const std::size_t row = (size(channel) * rows + size(z + 1)) * rows + size(y + 1);
  switch (format.layout) {
    case Layout::image: {
      const ImageExtent extent = image_extent(shape);
      const std::size_t step = size(shape.n + 1);
      const std::size_t ty = size(y) + size(channel) * step, tz = size(z) + i / kTexel * step;
      return ((tz * extent.y + ty) * extent.x + size(x)) * kTexel + i % kTexel;
    }
    case Layout::tiled:
      return ((row * blocks_per_row(shape) + 1 + size(x / kTile)) * n + i) * kTile +
             size(x % kTile);
    case Layout::aos:
      return (row * row_pitch(shape) + size(x + 1)) * n + i;
    case Layout::soa:
      break;
  }
  return (size(channel) * n + i) * bordered_cells(shape) +
         (size(z + 1) * rows + size(y + 1)) * row_pitch(shape) + size(x + 1);
}

}  // namespace clpv
