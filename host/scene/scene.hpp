// SPDX-License-Identifier: MIT
// A scene at one time: triangles, materials, textures, cameras and lights, in metres. Does not
// depend on OpenCL.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clpv/scene.hpp"
#include "kernels/shared/light.h"
#include "kernels/shared/mesh.h"
#include "support/error.hpp"
#include "support/named_enum.hpp"

namespace clpv {

// Rays through a homogeneous medium in a box (kernels/shared/light.h; docs/method.md, 'Media'), in
// double.

/// Part of a ray inside a medium, in lengths of the ray's direction; empty if end <= start.
struct MediumPart {
  double start = 0, end = 0;

  double length() const { return end > start ? end - start : 0; }
};

/// Returns the part of origin + t direction, t in (0, end), in the medium; none if the medium does
/// not attenuate. `end` may be infinite.
MediumPart medium_part(const ClpvMedium& medium, const glm::dvec3& origin,
                       const glm::dvec3& direction, double end);

/// exp(-sigma_t l) for each channel. `part`: of a ray with a unit direction [m].
glm::dvec3 transmittance(const ClpvMedium& medium, const MediumPart& part);

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

/// Returns the box about all vertices. An empty box at the origin without any.
Bounds bounds_of(const std::vector<Vertex>& vertices);

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

// Kinds of lights, with their names in scene files and glTF. Switches over them have no default, so
// that the compiler finds all places for a new kind.

static_assert(static_cast<unsigned>(LightKind::directional) == CLPV_LIGHT_DIRECTIONAL &&
              static_cast<unsigned>(LightKind::spot) == CLPV_LIGHT_SPOT &&
              static_cast<unsigned>(LightKind::point) == CLPV_LIGHT_POINT);

template <>
inline constexpr auto kNames<LightKind> = name_list("directional", "spot", "point");

/// Kind of a light. Throws Error(bad_input) for an invalid number.
inline LightKind kind_of(const ClpvLight& light) {
  const auto kinds = values_of<LightKind>();
  if (light.kind < kinds.size()) return kinds[light.kind];
  throw Error(ExitCode::bad_input, "light kind: found {}; allowed: 0 to {} ({})", light.kind,
              kinds.size() - 1, fmt::join(names_of<LightKind>(), ", "));
}

/// Sets the cone of a spot light by KHR_lights_punctual. Angles are from the axis [rad], 0 <= inner
/// <= outer, 0 < outer: full intensity within `inner`, 0 beyond `outer`. Equal ones give a hard
/// edge, as sharp as floats resolve. A difference of cosines below 0.001, which the extension's
/// code rounds up, is computed as it is.
inline void set_cone(ClpvLight& light, double inner, double outer) {
  constexpr double kNarrow = 0.001;        // difference of cosines
  constexpr double kResolution = 0x1p-23;  // a float's relative resolution
  const double difference = std::cos(inner) - std::cos(outer);
  light.narrow_cone = difference < kNarrow;
  if (!light.narrow_cone) {
    light.cone_scale = static_cast<float>(1.0 / difference);
    light.cone_offset = static_cast<float>(-std::cos(outer) * light.cone_scale);
    return;
  }
  const double below_one = 2 * std::pow(std::sin(outer / 2), 2);  // 1 - cos(outer)
  const double edge = 2 * std::sin((outer + inner) / 2) * std::sin((outer - inner) / 2);
  light.cone_scale = static_cast<float>(1.0 / std::max(edge, kResolution * below_one));
  light.cone_offset = static_cast<float>(below_one * light.cone_scale);
}

/// Angles of a spot light's cone [rad], as set_cone() takes them.
struct Cone {
  double inner, outer;
};

inline Cone cone_of(const ClpvLight& light) {
  // The ramp is 0 and 1 where c is these.
  const double scale = light.cone_scale, at_outer = -light.cone_offset / scale,
               at_inner = (1 - light.cone_offset) / scale;
  const auto angle = [&light](double c) {
    return light.narrow_cone != 0 ? 2 * std::asin(std::sqrt(std::clamp(-c / 2, 0.0, 1.0)))
                                  : std::acos(std::clamp(c, -1.0, 1.0));
  };
  return {angle(at_inner), angle(at_outer)};
}

}  // namespace clpv
