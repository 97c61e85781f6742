// Images inside a page: as data: URIs, and errors as false colour.
#pragma once

#include <string>

#include "image/image.hpp"

namespace clpv::report {

/// "data:image/png;base64,..." of a display-encoded image.
std::string data_uri(const Image& shown);

/// Error relative to the truth's root mean square, 0 to `full_scale`, in the colours of `legend`: luminance of the
/// absolute difference over the pixels that show a surface in both; the others are left transparent.
Image false_colour(const Image& image, const Image& truth, double full_scale);

/// A bar of the colours false_colour uses, from 0 on the left.
Image legend(int width, int height);

}  // namespace clpv::report
