// SPDX-License-Identifier: MIT
// The size an encoded image claims, read without decoding it; and what of a PNG a decoder is given.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace clpv {

/// What an image file asks for, in its own words: they may be anything.
struct ImageClaim {
  std::int64_t width = 0, height = 0;  ///< [pixels]; of the data window
  std::int64_t chunk_width = 0,
               chunk_height = 0;  ///< [pixels]; of what is decoded at once: a tile, or some rows
  std::int64_t channels = 0;      ///< at most: of those of one name, one counts
  bool tiled = false;
  bool deep = false;  ///< or a volume
};

enum class ImageFormat { png, jpeg };

struct ImageHeader {
  ImageFormat format;
  std::uint32_t width, height;
  bool complete;  ///< its end is there; and, of a PNG, all chunks before it are as long as they say
};

/// Nothing where the bytes are neither PNG nor JPEG, or their header is cut off.
std::optional<ImageHeader> read_image_header(std::span<const std::uint8_t> bytes);

/// Of a complete PNG, the chunks that its pixels need, and its plain texts. Others may be packed, and libpng makes room for
/// what they say they are when unpacked.
std::vector<std::uint8_t> bare_png(std::span<const std::uint8_t> bytes);

/// The claim of an OpenEXR file's first part, after a walk through the headers of all (OpenEXR's documentation, "File Layout"). Each attribute must have
/// its type's size, and it and each part's table of chunks must fit into the file: then headers and tables take no more memory
/// than the file has bytes. Each of several parts must be of a type that OpenEXR checks. What is missing, or has values that
/// mean nothing, is OpenEXR's to reject. Throws Error(bad_input) that names the file, the part and the attribute, what was
/// found, and what is allowed.
ImageClaim read_exr_header(const std::filesystem::path& path, std::span<const unsigned char> bytes);

}  // namespace clpv
