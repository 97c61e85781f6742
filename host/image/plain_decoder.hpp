// SPDX-License-Identifier: MIT
// Decoders of a build without OpenImageIO (CLPV_IMAGES=OFF).
#pragma once

#include "image/codec.hpp"

namespace clpv {

/// Opens a PNG of 8 bits or a JPEG (stb_image), or an EXR as plain_codec.cpp writes it: rows of
/// floats without compression, whose header read_exr_header() accepted. Returns null and sets
/// `error` for others.
std::unique_ptr<ImageDecoder> open_plain(const std::string& format,
                                         std::span<const std::uint8_t> bytes, std::string& error);

}  // namespace clpv
