// SPDX-License-Identifier: MIT
// Images that commands read.
#pragma once

#include <filesystem>
#include <string>

#include "image/image.hpp"

namespace clpv {

/// Reads a layer of an image file, and logs what reading converted or ignored. Throws as read_image
/// and extract_layer.
Image read_image_layer(const std::filesystem::path& file, const std::string& layer);

}  // namespace clpv
