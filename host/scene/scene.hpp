// SPDX-License-Identifier: MIT
// What is lit, at one instant: triangles, materials, textures, cameras and lights. Plain data in metres; knows no OpenCL.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kernels/shared/light.h"
#include "kernels/shared/mesh.h"

namespace clpv {

class Fingerprint;
struct Sky;

using Vertex = ClpvVertex;
using Triangle = ClpvTriangle;
using Material = ClpvMaterial;

static_assert(sizeof(ClpvVertex) == CLPV_SIZEOF_VERTEX && sizeof(ClpvTriangle) == CLPV_SIZEOF_TRIANGLE &&
              sizeof(ClpvMaterial) == CLPV_SIZEOF_MATERIAL && sizeof(ClpvTexture) == CLPV_SIZEOF_TEXTURE &&
              sizeof(ClpvLight) == CLPV_SIZEOF_LIGHT);

/// RGBA, 8 bits each, row 0 first (v = 0): sRGB-encoded colour, linear alpha.
struct Texture {
  std::uint32_t width = 0, height = 0;
  std::uint32_t wrap_u = CLPV_WRAP_REPEAT, wrap_v = CLPV_WRAP_REPEAT;
  std::vector<std::uint8_t> rgba;
  std::string name;
};

/// Three numbers of the structs that are shared with kernels.
inline glm::dvec3 vector(const float v[3]) {
  return {v[0], v[1], v[2]};
}

struct Camera {
  std::string name;
  glm::vec3 eye{0};              ///< [m]
  glm::vec3 forward{0, 0, -1};   ///< unit
  glm::vec3 up{0, 1, 0};         ///< unit, across forward
  float vertical_fov = 1.0472f;  ///< [rad], in (0, pi)
  float near_depth = 0.05f;      ///< [m]
  std::string light;             ///< the only light that shines with this camera; empty: all of them
};

struct Light {
  std::string name;
  ClpvLight data{};
};

/// An axis-aligned box [m].
struct Bounds {
  glm::vec3 lower{0}, upper{0};
};

/// A run of a scene's vertices and triangles.
struct Part {
  std::uint32_t first_vertex, vertices, first_triangle, triangles;
};

struct Scene {
  std::string name;  ///< the file's stem
  std::string path;  ///< the file it came from
  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;
  std::vector<Material> materials;  ///< at least one, where there are triangles
  std::vector<Texture> textures;
  std::vector<Part> moving;     ///< what of its vertices and triangles changes with time
  std::vector<Camera> cameras;  ///< at least one after loading
  std::vector<Light> lights;
  std::shared_ptr<const Sky> sky;     ///< null: nothing shines from beyond the scene
  glm::vec3 lower{0}, upper{0};       ///< bounding box [m]
  std::optional<double> start_reach;  ///< reach() at 0 s, of a scene that moves
  float exposure = 0;                 ///< [EV]: the shown image is radiance x 2^exposure
  std::optional<float> cascade_size;  ///< the scene file's wish for the finest cascade's edge [m]
  std::optional<int> cascades;
  std::vector<std::string>
      notes;  ///< what the loader decided and a user should be told ("no light: added a sun")

  /// How far the bounding box reaches from the eye of any camera, along any axis [m]; of a scene that moves, at 0 s.
  double reach() const;

  /// The camera of that name; empty: the first. Throws Error(usage) that lists the names there are.
  const Camera& camera(const std::string& name) const;

  /// The lights that shine when seen through `camera`: the one it names, or all.
  std::vector<Light> lights_for(const Camera& camera) const;
};

/// Adds what of a scene's triangles changes with time, as it is now; or one part of that.
void add_moving(Fingerprint& print, const Scene& scene);
void add_part(Fingerprint& print, const Scene& scene, const Part& part);

}  // namespace clpv
