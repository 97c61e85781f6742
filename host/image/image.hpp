// SPDX-License-Identifier: MIT
// Layers of an image: extraction and composition.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "clpv/image.hpp"
#include "kernels/shared/view.h"

namespace clpv {

class Fingerprint;

/// An image whose pixels are 0.
Image make_image(int width, int height, std::vector<std::string> channels);

/// Throws Error(bad_input), which begins with `name`, unless the fields of an image agree: sides of
/// 1 to 16384 pixels, a number for each pixel and channel, and channels of different names.
void check_image(const std::string& name, const Image& image);

/// Layer in the name of a channel: "indirect" of "indirect.R".
std::string_view layer_of(std::string_view channel);

/// Names of the layers, in order of first appearance. The unnamed layer is "".
std::vector<std::string> layers(const Image& image);

/// Image with the channels of one layer, named without the layer, and with the metadata. In a file
/// of several parts the layer may be that of the only part which has it (among several, the only
/// one with R, G and B). Throws Error(bad_input) that lists the layers if there is no such layer;
/// `source` is the file in the message.
Image extract_layer(const Image& image, const std::string& layer, const std::string& source);

/// Appends the channels of `addition` to `image` as `layer`. Sizes and encodings must be equal,
/// unless `image` has no channels.
void append_layer(Image& image, const Image& addition, const std::string& layer);

/// A display value as 8 bits; NaN becomes 0.
std::uint8_t byte_of(float value);

/// Adds size, channels and values to a hash, those that a written file has: sRGB-encoded ones with
/// 8 bits, channels in any order.
void add_pixels(Fingerprint& print, const Image& image);

// RSM or G-buffer on the host. Does not depend on OpenCL.

/// Unit normal of the triangle of a camera's pixel, from its stored normal
/// (kernels/shared/normal.h).
glm::dvec3 geometric_normal(const glm::vec4& normal);
/// Normal along which lookups in volumes and origins of rays are lifted.
glm::dvec3 lift_normal(const glm::vec4& normal);
glm::dvec3 lift_normal(const glm::dvec3& shading, const glm::dvec3& geometric);
/// Stored normal with these unit vectors.
glm::vec4 stored_normal(const glm::dvec3& shading, const glm::dvec3& geometric);

/// Host copy of a Surface (pipeline/raster/surface.hpp), input of the CPU reference. One value per
/// pixel, row 0 first. Depth [m] is along the view's forward axis, 0 without a surface; normals and
/// colours are as in Surface.
struct SurfaceImage {
  ClpvView view{};
  std::vector<float> depth;
  std::vector<glm::vec4> normal, colour, emissive;  ///< xyz; w: geometric_normal(), else unused
  std::vector<glm::vec4> position = {};  ///< [m], in place of depth for points without a view
};

}  // namespace clpv
