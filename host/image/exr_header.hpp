// SPDX-License-Identifier: MIT
// What an OpenEXR file says of its size, read without OpenEXR, which takes memory by its headers as it reads them.
#pragma once

#include <filesystem>
#include <span>

#include "image/image_header.hpp"

namespace clpv {

/// The first part's, after a walk through the headers of all (OpenEXR's documentation, "File Layout"). Each attribute must have
/// its type's size, and it and each part's table of chunks must fit into the file: then headers and tables take no more memory
/// than the file has bytes. Each of several parts must be of a type that OpenEXR checks. What is missing, or has values that
/// mean nothing, is OpenEXR's to reject. Throws Error(bad_input) that names the file, the part and the attribute, what was
/// found, and what is allowed.
ImageClaim read_exr_header(const std::filesystem::path& path, std::span<const unsigned char> bytes);

}  // namespace clpv
