// SPDX-License-Identifier: MIT
// Meshes and materials in memory, for Scene::add_mesh().
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "clpv/image.hpp"

namespace clpv {

/// Diffuse surface, as glTF describes it.
struct Material {
  /// Rows of RGBA with 8 bits each, sRGB-encoded colour and linear alpha; the first row has v = 0.
  /// Texture coordinates outside 0..1 repeat it.
  struct Texture {
    std::uint32_t width = 0, height = 0;  ///< 1 to 16384
    std::vector<std::uint8_t> rgba;       ///< 4 * width * height

    /// Encodes an image with channels R, G, B and optionally A. Throws Error(bad_input) for other
    /// channels, fields that disagree, and numbers outside of 0..1.
    static Texture of(const Image& image);
    bool operator==(const Texture&) const = default;
  };

  std::array<double, 4> base_colour{
      1, 1, 1, 1};  ///< linear albedo and alpha, 0..1; times texture and vertex colour
  std::array<double, 3> emission{};  ///< radiance of the front [W/m^2/sr], 0..1e9
  std::optional<Texture> texture{};  ///< needs Mesh::uvs
  /// 0..1: where alpha is less, there is a hole; none: no holes.
  std::optional<double> alpha_cutoff{};
  bool double_sided = false;  ///< visible, and emissive, from both sides
  bool operator==(const Material&) const = default;
};

/// Affine transform: rows of a 4 x 4 matrix, whose last one is 0, 0, 0, 1. Multiplies columns (x,
/// y, z, 1).
using Transform = std::array<std::array<double, 4>, 4>;
inline constexpr Transform kIdentity{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

/// Triangles in memory, which add_mesh() copies.
struct Mesh {
  std::span<const std::array<float, 3>> positions{};  ///< positions of vertices [m], y up
  /// Vertices, counter-clockwise seen from the front.
  std::span<const std::array<std::uint32_t, 3>> triangles{};
  std::span<const std::array<float, 3>> normals{};  ///< normals of vertices, of any length
  std::span<const std::array<float, 2>> uvs{};      ///< texture coordinates of vertices
  std::span<const std::array<float, 4>> colours{};  ///< linear, of vertices; times the material's
  /// Used only if `normals` is empty. True: vertex normals are angle-weighted means of the
  /// triangles'; false: flat, as in glTF.
  bool smooth = false;
  Material material{};
  /// Will move: its first move then needs no new memory (Scene::set_positions).
  bool moves = false;
};

}  // namespace clpv
