// SPDX-License-Identifier: MIT
// A scene at one time: triangles, materials, textures, cameras and lights, in metres. Does not
// depend on OpenCL.
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

/// Texture of RGBA with 8 bits per channel, row 0 (v = 0) first: sRGB-encoded colour, linear alpha.
struct Texture {
  std::uint32_t width = 0, height = 0;
  std::uint32_t wrap_u = CLPV_WRAP_REPEAT, wrap_v = CLPV_WRAP_REPEAT;
  std::vector<std::uint8_t> rgba;
  std::string name;
};

/// Vector of three floats, as the structs shared with kernels have them.
inline glm::dvec3 vector(const float v[3]) {
  return {v[0], v[1], v[2]};
}

/// White, opaque, visible from its front, without texture.
ClpvMaterial blank_material();

struct SceneCamera {
  std::string name;
  glm::vec3 eye{0};              ///< [m]
  glm::vec3 forward{0, 0, -1};   ///< unit
  glm::vec3 up{0, 1, 0};         ///< unit, perpendicular to forward
  float vertical_fov = 1.0472f;  ///< [rad], in (0, pi)
  float near_depth = 0.05f;      ///< [m]
  std::string light;             ///< name of the only light for this camera; empty: all lights
};

struct SceneLight {
  std::string name;
  ClpvLight data{};
};

/// Axis-aligned box [m].
struct Bounds {
  glm::vec3 lower{0}, upper{0};
};

/// Range of a scene's vertices and triangles.
struct MeshRange {
  std::uint32_t first_vertex, vertices, first_triangle, triangles;
};

struct SceneData {
  std::string name;  ///< the file's stem
  std::string path;  ///< the scene's file
  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;
  std::vector<ClpvMaterial> materials;  ///< at least one if there are triangles
  std::vector<Texture> textures;
  std::vector<MeshRange> moving;     ///< animated vertices and triangles
  std::vector<SceneCamera> cameras;  ///< at least one after loading
  std::vector<SceneLight> lights;
  float light_scale = 1;              ///< factor of the intensities of all lights
  std::shared_ptr<const Sky> sky;     ///< null without a sky
  std::optional<ClpvMedium> medium;   ///< fog or dust
  glm::vec3 lower{0}, upper{0};       ///< bounding box [m]
  std::optional<double> start_reach;  ///< reach() at 0 s, for animated scenes
  std::optional<float> exposure;      ///< [EV]: display values are radiance x 2^exposure
  std::optional<float> cascade_size;  ///< edge of the finest cascade from the scene file [m]
  std::optional<int> cascades;        ///< number of cascades from the scene file
  std::vector<std::string> notes;     ///< notes of the loader to the user ("no light: added a sun")

  /// Largest distance along an axis from a camera's eye to the bounding box's faces [m]; animated
  /// scenes: at 0 s.
  double reach() const;

  /// The camera with this name, or the first for an empty name. Throws Error(usage) that lists all
  /// names.
  const SceneCamera& camera(const std::string& name) const;

  bool has_light(const std::string& name) const;
  /// Lights for a camera, the one it names if there is one, else all, scaled and in the scene's
  /// medium.
  std::vector<SceneLight> lights_for(const SceneCamera& camera) const;
};

/// Hash of all scene content that affects light, apart from lights: geometry, materials, textures,
/// sky and medium.
std::string scene_fingerprint(const SceneData& scene);
/// Adds the animated vertices and triangles to a hash.
void add_moving(Fingerprint& print, const SceneData& scene);
/// Adds the vertices and triangles of a range to a hash.
void add_range(Fingerprint& print, const SceneData& scene, const MeshRange& range);

}  // namespace clpv
