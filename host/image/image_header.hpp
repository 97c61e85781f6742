// SPDX-License-Identifier: MIT
// Size of an encoded image by its header, read without decoding, and removal of unneeded chunks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/primaries.hpp"
#include "support/named_enum.hpp"

namespace clpv {

/// Size of an image as its file declares it, unchecked.
struct DeclaredImage {
  std::int64_t width = 0, height = 0;  ///< size of the data window [pixels]
  /// Size of a tile, or of the rows decoded at once [pixels].
  std::int64_t chunk_width = 0, chunk_height = 0;
  std::int64_t channels = 0;
  bool tiled = false;
  bool deep = false;  ///< deep image or volume
};

/// Rectangle of an EXR file's pixels, both corners included.
struct ExrWindow {
  std::int64_t left = 0, top = 0, right = -1, bottom = -1;
  bool operator==(const ExrWindow&) const = default;
  std::int64_t width() const { return right - left + 1; }
  std::int64_t height() const { return bottom - top + 1; }
};

/// Header of one part of an EXR file; its size is that of the data window.
struct ExrHeader : DeclaredImage {
  std::string name;
  ExrWindow data;
  ExrWindow display;  ///< the data window if the file has no other
  std::optional<Chromaticities> chromaticities;
  bool cube_map = false;
};

enum class ImageFormat { png, jpeg, webp };

template <>
inline constexpr auto kNames<ImageFormat> = name_list("png", "jpeg", "webp");

struct ImageHeader {
  ImageFormat format;
  std::uint32_t width, height;
  bool complete;  ///< the end marker is present, and all chunks fit into the file
};

/// Reads the header of a PNG, JPEG or WebP; empty for other or truncated bytes, and for an animated
/// WebP.
std::optional<ImageHeader> read_image_header(std::span<const std::uint8_t> bytes);

/// Copies a complete PNG with only those chunks that its pixels need, and uncompressed texts.
/// libpng would allocate memory for the declared size of compressed ones.
std::vector<std::uint8_t> strip_png(std::span<const std::uint8_t> bytes);

/// Copies a complete WebP with only the chunks that its pixels need. Without `alpha` the copy is
/// opaque: OpenImageIO multiplies colours by alpha, which 8 bits do not undo.
std::vector<std::uint8_t> strip_webp(std::span<const std::uint8_t> bytes, bool alpha);

/// Returns the colour data of a complete PNG that says otherwise than sRGB, such as "gAMA 1"; empty
/// if there is none. A chunk sRGB overrides the others.
std::string foreign_colour(std::span<const std::uint8_t> png);

/// Validates and returns the headers of all parts of an OpenEXR file (OpenEXR's documentation,
/// "File Layout"). Each attribute must have its type's size, and it and each part's table of chunks
/// must fit into the file, so headers and tables take no more memory than the file has bytes. Each
/// of several parts must be of a type that OpenEXR checks. OpenEXR itself rejects missing
/// attributes and meaningless values. Throws Error(bad_input) that names the file, part, attribute,
/// value found and value allowed.
std::vector<ExrHeader> read_exr_header(const std::filesystem::path& path,
                                       std::span<const unsigned char> bytes);

}  // namespace clpv
