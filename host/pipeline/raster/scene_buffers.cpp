// SPDX-License-Identifier: MIT
#include "pipeline/raster/scene_buffers.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "kernels/shared/raster.h"
#include "scene/emission.hpp"
#include "scene/mip_chain.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

void require(bool holds, const std::string& message) {
  if (!holds) throw Error(ExitCode::bad_input, message);
}

/// Kernels do not check indices, so this rejects invalid ones of any scene.
void check_indices(const SceneData& scene) {
  require(
      scene.triangles.size() <= CLPV_TRIANGLE_INDEX && scene.vertices.size() <= CLPV_TRIANGLE_INDEX,
      fmt::format("{}: {} triangles and {} vertices; allowed: below 2^30 each", scene.path,
                  scene.triangles.size(), scene.vertices.size()));
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    const Triangle& t = scene.triangles[i];
    const unsigned top = std::max({t.vertex[0], t.vertex[1], t.vertex[2]});
    require(top < scene.vertices.size() && t.material < scene.materials.size(),
            fmt::format("{}: triangle {} uses vertex {} of {} and material {} of {}", scene.path, i,
                        top, scene.vertices.size(), t.material, scene.materials.size()));
  }
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    for (const unsigned texture :
         {scene.materials[i].texture, scene.materials[i].emissive_texture}) {
      require(texture == CLPV_NO_TEXTURE || texture < scene.textures.size(),
              fmt::format("{}: material {} uses texture {} of {}", scene.path, i, texture,
                          scene.textures.size()));
    }
  }
}

void check_texture(const SceneData& scene, const Texture& texture) {
  constexpr std::uint32_t kLargest = 1u << (CLPV_TEXTURE_LEVELS - 1);
  require(texture.width >= 1 && texture.height >= 1 && texture.width <= kLargest &&
              texture.height <= kLargest,
          fmt::format("{}: texture {} is {} x {}; allowed: 1 to {} along each side", scene.path,
                      texture.name, texture.width, texture.height, kLargest));
  require(texture.rgba.size() == std::size_t{4} * texture.width * texture.height,
          fmt::format("{}: texture {} has {} bytes for {} x {} texels", scene.path, texture.name,
                      texture.rgba.size(), texture.width, texture.height));
}

struct TextureTable {
  std::vector<ClpvTexture> levels;
  std::vector<std::uint32_t> texels;
};

/// Rounds a side up to whole blocks of texels (ClpvTexture).
std::size_t to_blocks(std::size_t side) {
  return (side + 3) / 4 * 4;
}

/// Writes a level in blocks of 4 x 4 texels, row by row; texels beyond its sides stay.
void write_blocks(const Texture& level, std::uint32_t* to) {
  const std::size_t row_of_blocks = 4 * to_blocks(level.width);
  for (std::size_t y = 0; y < level.height; ++y) {
    for (std::size_t x = 0; x < level.width; x += 4) {
      const std::size_t count = std::min<std::size_t>(level.width - x, 4);
      std::memcpy(to + y / 4 * row_of_blocks + y % 4 * 4 + x * 4,
                  &level.rgba[4 * (y * level.width + x)], count * sizeof *to);
    }
  }
}

void append(TextureTable& table, const std::vector<Texture>& chain) {
  for (std::size_t level = 0; level < CLPV_TEXTURE_LEVELS; ++level) {
    if (level >= chain.size()) {
      table.levels.push_back(table.levels.back());
      continue;
    }
    const Texture& texture = chain[level];
    const std::size_t offset = table.texels.size();
    const std::size_t count = to_blocks(texture.width) * to_blocks(texture.height);
    require(offset + count <= std::numeric_limits<std::uint32_t>::max(),
            "more than 2^32 texels in all textures");
    table.levels.push_back({static_cast<unsigned>(offset), texture.width, texture.height,
                            texture.wrap_u + 16 * texture.wrap_v});
    table.texels.resize(offset + count);
    write_blocks(texture, &table.texels[offset]);
  }
}

bool is_masked(const ClpvMaterial& material) {
  return (material.flags & CLPV_MATERIAL_MASKED) != 0;
}

TextureTable make_table(const SceneData& scene) {
  const std::vector<bool> holes = textures_with_holes(scene);
  TextureTable table;
  for (std::size_t i = 0; i < holes.size(); ++i) {
    check_texture(scene, scene.textures[i]);
    append(table, mip_chain(scene.textures[i], holes[i]));
  }
  Texture white;  // white texture for materials without one
  white.width = white.height = 1;
  white.rgba.assign(4, 255);
  append(table, {white});
  return table;
}

bool is_coloured(const std::vector<Vertex>& vertices) {
  return std::any_of(vertices.begin(), vertices.end(), [](const Vertex& v) {
    return std::any_of(v.colour, v.colour + 3, [](float c) { return c != 1; });
  });
}

bool is_textured(const ClpvMaterial& material) {
  return material.texture != CLPV_NO_TEXTURE || material.emissive_texture != CLPV_NO_TEXTURE;
}

/// Assigns the white texture to materials without one, so that kernels need no test.
std::vector<ClpvMaterial> with_textures(std::vector<ClpvMaterial> materials, unsigned white) {
  for (ClpvMaterial& material : materials) {
    if (material.texture == CLPV_NO_TEXTURE) material.texture = white;
    if (material.emissive_texture == CLPV_NO_TEXTURE) material.emissive_texture = white;
  }
  return materials;
}

}  // namespace

SceneBuffers upload_scene(Session& session, const SceneData& scene) {
  check_indices(scene);
  const TextureTable table = make_table(scene);
  SceneBuffers buffers;
  buffers.vertices = session.upload(scene.vertices, "vertices");
  buffers.triangles = session.upload(scene.triangles, "triangles");
  buffers.white = scene.textures.size();
  buffers.materials = session.upload(with_textures(scene.materials, buffers.white), "materials");
  buffers.textures = session.upload(table.levels, "texture table");
  buffers.texels = session.upload(table.texels, "textures");
  buffers.triangle_count = scene.triangles.size();
  buffers.textured = std::any_of(scene.materials.begin(), scene.materials.end(), is_textured);
  buffers.coloured = is_coloured(scene.vertices);
  buffers.emissive = std::ranges::any_of(
      scene.materials, [](const ClpvMaterial& material) { return emits(material); });
  buffers.masked = std::any_of(scene.materials.begin(), scene.materials.end(), is_masked);
  buffers.medium = scene.medium.has_value();
  buffers.bounds = bounds_of(scene.vertices);
  buffers.clusters = std::make_shared<TriangleClusters>(scene);
  return buffers;
}

void upload_moving(Session& session, const SceneData& scene, SceneBuffers& buffers) {
  const std::vector<MeshRange> changed = buffers.clusters->move(scene);
  if (changed.empty()) return;
  for (const MeshRange& part : changed) {
    session.write(buffers.vertices,
                  std::span(scene.vertices).subspan(part.first_vertex, part.vertices),
                  part.first_vertex);
    session.write(buffers.triangles,
                  std::span(scene.triangles).subspan(part.first_triangle, part.triangles),
                  part.first_triangle);
  }
  buffers.bounds = bounds_of(scene.vertices);
}

}  // namespace clpv
