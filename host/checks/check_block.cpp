// SPDX-License-Identifier: MIT
// Triangles that block: the kernels against the twin on a soup of triangles, of all sizes and with holes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "checks/check.hpp"
#include "checks/tolerances.hpp"
#include "pipeline/block.hpp"
#include "reference/block.hpp"

namespace clpv::reference {
namespace {

constexpr int kGrid = 9;  // no multiple of anything
const ClpvGrid kCells = {{-2.5f, 0.5f, 1.0f}, 0.5f, kGrid, {}};

void add_materials(Scene& scene, std::mt19937& random) {
  Texture texture{.width = 5, .height = 4, .wrap_u = CLPV_WRAP_MIRROR, .rgba = {}, .name = "holes"};
  for (int i = 0; i < 5 * 4 * 4; ++i) texture.rgba.push_back(static_cast<std::uint8_t>(random() % 256));
  scene.textures.push_back(texture);
  for (const unsigned flags : {0u, CLPV_MATERIAL_MASKED}) {
    Material material{{1, 1, 1, 0.9f}, {}, 0.4f, 0, CLPV_NO_TEXTURE, flags, 0};
    scene.materials.push_back(material);
  }
}

/// Specks, triangles of some cells, others far larger than the grid, one without area, some seen edge-on.
Scene soup() {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto direction = [&] { return glm::vec3(uniform(random), uniform(random), uniform(random)); };
  Scene scene;
  add_materials(scene, random);
  const glm::vec3 middle(-0.25f, 2.75f, 3.25f);
  for (int i = 0; i < 150; ++i) {
    const float size = std::exp(6 * uniform(random) - 3);  // 0.0025 to 20 m
    const glm::vec3 at = middle + (i % 10 == 9 ? 6.0f : 2.5f) * direction();
    Triangle triangle{{}, static_cast<unsigned>(i % 3 == 0)};
    for (unsigned& vertex : triangle.vertex) {
      glm::vec3 p = at + size * direction();
      if (i % 7 == 3) p[i % 3] = at[i % 3];
      if (i == 20) p = at;
      vertex = static_cast<unsigned>(scene.vertices.size());
      scene.vertices.push_back(
          {{p.x, p.y, p.z}, {0, 0, 1}, {2 * uniform(random), 2 * uniform(random)}, {1, 1, 1, 0.95f}});
    }
    scene.triangles.push_back(triangle);
  }
  return scene;
}

CheckResult check_one(Session& session, const Scene& scene, const Blocked& twin, const VolumeFormat& format) {
  const VolumeShape shape{kGrid + 1, 3, 1};
  clpv::Volume geometry(session, shape, "check: blockers", format);
  const SceneBuffers buffers = upload_scene(session, scene);
  SceneBlocker(session, buffers, kGrid, format).block(kCells, geometry);
  const std::vector<float> found = geometry.read(session);
  CheckResult result{"block", format_name(format), 0, tolerance_in("block", format), {}};
  for (std::size_t at = 0; at < found.size(); ++at) {
    const double share = found[at];
    const double outside = std::max({0.0, twin.least.values[at] - share, share - twin.most.values[at]});
    if (outside <= result.worst && !std::isnan(share)) continue;
    result.worst = std::isnan(share) ? share : outside;
    const std::size_t n = kGrid + 1;
    result.place =
        fmt::format("corner {},{},{} axis {}: {}, twin {} to {}", at % n, at / n % n, at / n / n % n,
                    at / n / n / n, share, twin.least.values[at], twin.most.values[at]);
    if (std::isnan(share)) break;
  }
  return result;
}

}  // namespace

CheckResults check_block(Session& session) {
  const Scene scene = soup();
  const Blocked twin = block(scene, kCells);
  CheckResults results{check_one(session, scene, twin, {})};
  for (const VolumeFormat& format : other_formats(session.device(), {kGrid + 1, 3, 1}))
    results.push_back(check_one(session, scene, twin, format));
  return results;
}

}  // namespace clpv::reference
