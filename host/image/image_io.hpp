// SPDX-License-Identifier: MIT
// Images in and out, through OpenImageIO: EXR, PNG and Radiance HDR in; EXR and PNG out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "image/image.hpp"

namespace clpv {

/// What an image file may hold; checked before memory is taken for it.
struct ImageLimits {
  std::uintmax_t file_bytes = std::uintmax_t{1} << 30;
  int side = 16384;  ///< pixels
  int channels = 256;
  std::size_t pixel_bytes = std::size_t{1} << 30;  ///< as float
};

/// Reads an EXR, PNG or HDR file, all channels, the finest level of the first part. PNG: values in [0,1], as
/// they are encoded (Encoding::srgb), alpha not multiplied in. The name's extension and the content must
/// agree. Throws Error(bad_input) that names the file, what was found, and what is allowed.
Image read_image(const std::filesystem::path& path, const ImageLimits& limits = {});

/// The metadata alone, of a file that read_image reads; pixels are not looked at. Throws as it does.
std::map<std::string, std::string> read_metadata(const std::filesystem::path& path,
                                                 const ImageLimits& limits = {});

/// Writes 32-bit float EXR with the image's channel names; metadata goes in as string attributes "clpv:NAME"
/// (and comes back from read_image). The same image gives the same bytes. Throws Error(run_time).
void write_exr(const std::filesystem::path& path, const Image& image);

/// An 8-bit PNG file of a display-encoded image (display_image): R,G,B or R,G,B,A in [0,1]. Metadata goes in as text.
std::vector<unsigned char> png_bytes(const Image& image);

/// The same, in a file.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace clpv
