// SPDX-License-Identifier: MIT
// Images, which are part of the library's door, taken apart and put together by layers.
#pragma once

#include <string>
#include <vector>

#include "clpv/image.hpp"

namespace clpv {

/// An image of zeros.
Image make_image(int width, int height, std::vector<std::string> channels);

/// The layers' names, in order of first appearance.
std::vector<std::string> layers(const Image& image);

/// The channels of one layer, named without it; metadata kept. Throws Error(bad_input) that lists the layers
/// there are; `source` names the file in the message.
Image extract_layer(const Image& image, const std::string& layer, const std::string& source);

/// Adds the channels of `addition` to `image` as `layer`; both have the same size. To an image without pixels
/// yet, gives its size.
void append_layer(Image& image, const Image& addition, const std::string& layer);

}  // namespace clpv
