// SPDX-License-Identifier: MIT
// Image files: reads EXR, PNG and Radiance HDR, writes EXR and PNG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "image/image.hpp"

namespace clpv {

/// Limits of an image file, checked before memory is allocated for it.
struct ImageLimits {
  std::uintmax_t file_bytes = std::uintmax_t{1} << 30;
  int side = 16384;  ///< width and height [pixels]
  int channels = 256;
  std::size_t pixel_bytes = std::size_t{1} << 30;  ///< decoded pixels, as float
};

/// Reads all channels of an EXR, PNG or HDR file. EXR: the finest level of all parts, placed in the
/// display window; several parts become layers. Linear R, G and B of EXR and HDR are those of Rec.
/// 709. PNG: sRGB-encoded values in [0, 1] (Encoding::srgb) with unassociated alpha. docs/scenes.md
/// says what is converted and rejected. Extension and content must agree. Throws Error(bad_input)
/// that names the file, the value found and the values allowed.
Image read_image(const std::filesystem::path& path, const ImageLimits& limits = {});

/// Decodes the bytes of such a file; `path` is its name. Throws as read_image.
Image decode_image(const std::filesystem::path& path, std::string_view bytes);

/// Reads only the metadata of a file. Throws as read_image, but does not decode pixels.
std::map<std::string, std::string> read_metadata(const std::filesystem::path& path,
                                                 const ImageLimits& limits = {});

/// Returns the members of a JSON object as metadata: texts as they are, others as JSON, and the
/// files `scene`, `model` and `centres` without their folders.
std::map<std::string, std::string> metadata_of(const nlohmann::json& described);

/// Encodes an image as EXR of 32-bit floats with its channel names. Metadata become string
/// attributes "clpv:NAME". Equal images give equal bytes. Throws Error(run_time).
std::vector<unsigned char> exr_bytes(const Image& image);

/// Writes exr_bytes() to a file. Throws Error(run_time).
void write_exr(const std::filesystem::path& path, const Image& image);

/// Encodes an sRGB-encoded image (display_image) with R, G, B and optionally A in [0, 1] as 8-bit
/// PNG, with metadata as text.
std::vector<unsigned char> png_bytes(const Image& image);

/// Writes png_bytes() to a file. Throws Error(run_time).
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace clpv
