// SPDX-License-Identifier: MIT
#include "pipeline/block.hpp"

#include <algorithm>

#include "codegen/cell_macros.hpp"

namespace clpv {
namespace {

constexpr std::size_t kGroup = 64;
// Triangles a launch: a device that watches over its display ends what takes seconds.
constexpr unsigned kMostTriangles = 1u << 20;
constexpr std::size_t kBytesACorner = 3 * sizeof(cl_ulong);

ProgramSource triangles_program(const SceneBuffers& scene, int grid) {
  ProgramSource source{"block.cl", {}, {}};
  source.literals.integer("CLPV_GRID", grid).flag("CLPV_MASKED", scene.masked);
  return source;
}

ProgramSource shares_program(int grid, const VolumeFormat& format) {
  ProgramSource source{"block_shares.cl", {}, coefficient_macros(3)};
  source.literals.integer("CLPV_GRID", grid);
  add_format_literals(source.literals, format);
  return source;
}

}  // namespace

std::size_t SceneBlocker::bytes(int grid) {
  const auto corners = static_cast<std::size_t>(grid) + 1;
  return corners * corners * corners * kBytesACorner;
}

SceneBlocker::SceneBlocker(Session& session, const SceneBuffers& scene, int grid, const VolumeFormat& format)
    : session_(session),
      scene_(scene),
      grid_(grid),
      masks_(session.buffer(bytes(grid), "masks of triangles that block")),
      triangles_(session, triangles_program(scene, grid), "block_triangles"),
      shares_(session, shares_program(grid, format), "block_shares") {}

void SceneBlocker::block(const ClpvGrid& grid, Volume& geometry) {
  session_.fill_zero(masks_, bytes(grid_));
  for (unsigned first = 0; first < scene_.triangle_count; first += kMostTriangles) {
    const cl_uint count = std::min(scene_.triangle_count - first, kMostTriangles);
    triangles_.set(grid, cl_uint{first}, count, scene_.vertices, scene_.triangles, scene_.materials,
                   scene_.textures, scene_.texels, masks_);
    triangles_.launch(cl::NDRange(count), cl::NDRange(kGroup));
  }
  shares_.set(masks_, geometry.memory());
  const auto corners = static_cast<std::size_t>(grid_) + 1;
  shares_.launch(cl::NDRange(corners, corners, corners), cl::NDRange(kGroup, 1, 1));
}

}  // namespace clpv
