// SPDX-License-Identifier: MIT
#include "checks/check_triangles.hpp"

#include <cmath>
#include <random>

namespace clpv::reference {
namespace {

void add_materials(Scene& scene, std::mt19937& random) {
  Texture texture{.width = 5, .height = 4, .wrap_u = CLPV_WRAP_MIRROR, .rgba = {}, .name = "holes"};
  for (int i = 0; i < 5 * 4 * 4; ++i) texture.rgba.push_back(static_cast<std::uint8_t>(random() % 256));
  scene.textures.push_back(texture);
  for (const unsigned flags : {0u, CLPV_MATERIAL_MASKED}) {
    Material material{{0.9f, 0.6f, 0.3f, 0.9f}, {}, 0.4f, 0, CLPV_NO_TEXTURE, flags, 0};
    scene.materials.push_back(material);
  }
}

}  // namespace

Scene triangle_soup() {
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
      scene.vertices.push_back({{p.x, p.y, p.z},
                                {0, 0, 1},
                                {2 * uniform(random), 2 * uniform(random)},
                                {0.8f, uniform(random) > 0 ? 0.6f : 1.0f, 1, 0.95f}});
    }
    scene.triangles.push_back(triangle);
  }
  return scene;
}

}  // namespace clpv::reference
