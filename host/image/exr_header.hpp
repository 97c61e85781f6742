// SPDX-License-Identifier: MIT
// What an OpenEXR file says of its size, read without OpenEXR, which takes memory by its headers as it reads them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace clpv {

/// What an image file asks for, in its own words: they may be anything.
struct ImageExtent {
  std::int64_t width = 0, height = 0;  ///< [pixels]; of the data window
  std::int64_t chunk_width = 0,
               chunk_height = 0;  ///< [pixels]; of what is decoded at once: a tile, or some rows
  std::int64_t channels = 0;      ///< at most: of those of one name, one counts
  bool tiled = false;
  bool deep = false;  ///< or a volume
};

/// The first part's, after a walk through the headers of all (OpenEXR's documentation, "File Layout"). Each attribute must have
/// its type's size, and it and each part's table of chunks must fit into the file: then headers and tables take no more memory
/// than the file has bytes. What is missing, or has values that mean nothing, is OpenEXR's to refuse. Throws
/// Error(bad_input) that names the file, the part and the attribute, what was found, and what is allowed.
ImageExtent read_exr_header(const std::filesystem::path& path, std::span<const unsigned char> bytes);

}  // namespace clpv
