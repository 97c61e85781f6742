// SPDX-License-Identifier: MIT
#include "scene/view_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "scene/bounds.hpp"
#include "scene/scene.hpp"
#include "scene/sky.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr double kMaxIntensity = 1e18;

glm::dvec3 dvec3(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

Vec3 vec3(const float v[3]) {
  return {v[0], v[1], v[2]};
}

/// In float, in which scenes store numbers.
std::string text_of(const Vec3& v) {
  return fmt::format("{},{},{}", float(v[0]), float(v[1]), float(v[2]));
}

void check_number(const char* member, double value, double minimum, double maximum,
                  const RejectMember& reject) {
  if (!(value >= minimum && value <= maximum))  // NaN is in no range
    reject(member, fmt::format("{}", value), fmt::format("{}..{}", minimum, maximum));
}

/// Checks that each component is within +-limit, or from 0 to limit.
glm::dvec3 checked(const char* member, const Vec3& value, double limit, bool may_be_negative,
                   const RejectMember& reject) {
  for (const double component : value) {
    if (!(component >= (may_be_negative ? -limit : 0) && component <= limit))
      reject(member, text_of(value),
             fmt::format("{}..{} each", may_be_negative ? -limit : 0, limit));
  }
  return dvec3(value);
}

glm::dvec3 point(const char* member, const Vec3& value, const RejectMember& reject) {
  return checked(member, value, bounds::kCoordinate, true, reject);
}

glm::dvec3 direction(const char* member, const Vec3& value, const RejectMember& reject) {
  const glm::dvec3 v = point(member, value, reject);
  if (glm::length(v) < bounds::kMinLength) reject(member, "a vector of no length", "a direction");
  return glm::normalize(v);
}

void store_floats(float out[3], const glm::dvec3& v) {
  for (int i = 0; i < 3; ++i) out[i] = static_cast<float>(v[i]);
}

}  // namespace

RejectMember rejected_in(const std::string& what) {
  return [what](const std::string& member, const std::string& found, const std::string& allowed) {
    throw Error(ExitCode::usage, "{}: {}{}found {}, allowed: {}", what, member,
                member.empty() ? "" : ": ", found, allowed);
  };
}

SceneCamera scene_camera(const Camera& camera, const RejectMember& reject, double metres_per_unit) {
  const glm::dvec3 eye = point("eye", camera.eye, reject),
                   towards = point("target", camera.target, reject) - eye;
  if (glm::length(towards) < bounds::kMinLength)
    reject("target", "the eye itself", "a point away from eye");
  check_number("vertical_fov_degrees", camera.vertical_fov_degrees, bounds::kMinFov,
               bounds::kMaxFov, reject);
  check_number("near", camera.near, bounds::kMinLength, bounds::kCoordinate, reject);
  const glm::dvec3 forward = glm::normalize(towards), up = direction("up", camera.up, reject);
  const glm::dvec3 perpendicular = up - forward * glm::dot(forward, up);
  if (glm::length(perpendicular) < bounds::kMinLength) {
    reject("up", fmt::format("{}, parallel to the viewing direction", text_of(camera.up)),
           "a vector that is not parallel to the viewing direction");
  }
  SceneCamera made;
  made.name = camera.name;
  made.light = camera.light;
  made.eye = glm::vec3(eye * metres_per_unit);
  made.forward = glm::vec3(forward);
  made.up = glm::vec3(glm::normalize(perpendicular));
  made.vertical_fov = static_cast<float>(glm::radians(camera.vertical_fov_degrees));
  made.near_depth = static_cast<float>(camera.near * metres_per_unit);
  return made;
}

SceneLight scene_light(const Light& light, const RejectMember& reject, double metres_per_unit) {
  SceneLight made;
  made.name = light.name;
  ClpvLight& data = made.data;
  if (name_of(light.kind).empty())
    reject("kind", fmt::format("{}", static_cast<unsigned>(light.kind)), "0..2");
  data.kind = static_cast<unsigned>(light.kind);
  store_floats(data.intensity, checked("intensity", light.intensity, kMaxIntensity, false, reject));
  if (light.kind != LightKind::directional) {
    store_floats(data.position, point("position", light.position, reject) * metres_per_unit);
    check_number("range", light.range, 0, bounds::kCoordinate, reject);
    data.range = static_cast<float>(light.range * metres_per_unit);
  }
  if (light.kind != LightKind::point)
    store_floats(data.direction, direction("direction", light.direction, reject));
  if (light.kind == LightKind::spot) {
    check_number("inner_cone_degrees", light.inner_cone_degrees, 0, 90, reject);
    check_number("outer_cone_degrees", light.outer_cone_degrees, bounds::kMinLength, 90, reject);
    if (light.inner_cone_degrees > light.outer_cone_degrees) {
      reject("",
             fmt::format("inner_cone_degrees {} and outer_cone_degrees {}",
                         light.inner_cone_degrees, light.outer_cone_degrees),
             "inner at most outer");
    }
    set_cone(data, glm::radians(light.inner_cone_degrees), glm::radians(light.outer_cone_degrees));
  }
  return made;
}

ClpvMedium scene_medium(const Medium& medium, const RejectMember& reject, double metres_per_unit) {
  const glm::dvec3 scattering =
                       checked("scattering", medium.scattering, bounds::kExtinction, false, reject),
                   absorption =
                       checked("absorption", medium.absorption, bounds::kExtinction, false, reject);
  check_number("anisotropy", medium.anisotropy, -bounds::kAnisotropy, bounds::kAnisotropy, reject);
  ClpvMedium made{};
  store_floats(made.scattering, scattering);
  store_floats(made.extinction, scattering + absorption);
  made.anisotropy = static_cast<float>(medium.anisotropy);
  if (!medium.box) return made;
  const glm::dvec3 lower = point("box", (*medium.box)[0], reject),
                   upper = point("box", (*medium.box)[1], reject);
  if (!glm::all(glm::greaterThan(upper, lower))) {
    reject("box", fmt::format("{} to {}", text_of((*medium.box)[0]), text_of((*medium.box)[1])),
           "an upper corner above the lower one");
  }
  store_floats(made.lower, lower * metres_per_unit);
  store_floats(made.upper, upper * metres_per_unit);
  return made;
}

std::shared_ptr<const Sky> scene_sky(const Vec3& above, const Vec3& below,
                                     const RejectMember& reject) {
  const glm::vec3 high(checked("above", above, bounds::kSkyRadiance, false, reject)),
      low(checked("below", below, bounds::kSkyRadiance, false, reject));
  if (high == glm::vec3(0) && low == glm::vec3(0)) return nullptr;
  return std::make_shared<Sky>(high == low ? constant_sky(high) : sky_with_ground(high, low));
}

std::shared_ptr<const Sky> scene_sky(const std::filesystem::path& map, double scale, double degrees,
                                     const RejectMember& reject) {
  check_number("scale", scale, 0, bounds::kSkyRadiance, reject);
  check_number("degrees", degrees, -360, 360, reject);
  return std::make_shared<Sky>(read_sky(map, scale, glm::radians(degrees)));
}

Medium medium_of(const ClpvMedium& medium) {
  const glm::vec3 scattering = glm::make_vec3(medium.scattering),
                  extinction = glm::make_vec3(medium.extinction);
  const glm::dvec3 absorption(extinction - scattering);
  return {vec3(medium.scattering),
          {absorption.x, absorption.y, absorption.z},
          double{medium.anisotropy},
          std::array{vec3(medium.lower), vec3(medium.upper)}};
}

Camera camera_of(const SceneCamera& camera) {
  const glm::dvec3 target = glm::dvec3(camera.eye) + glm::dvec3(camera.forward);
  return {{camera.eye.x, camera.eye.y, camera.eye.z},
          {target.x, target.y, target.z},
          {camera.up.x, camera.up.y, camera.up.z},
          glm::degrees(double{camera.vertical_fov}),
          camera.near_depth,
          camera.name,
          camera.light};
}

Light light_of(const SceneLight& light) {
  const ClpvLight& data = light.data;
  Light made{kind_of(data),
             vec3(data.position),
             vec3(data.direction),
             vec3(data.intensity),
             data.range,
             0,
             45,
             light.name};
  if (made.kind != LightKind::spot) return made;
  const Cone cone = cone_of(data);
  made.outer_cone_degrees = std::min(glm::degrees(cone.outer), 90.0);
  made.inner_cone_degrees = glm::degrees(cone.inner);
  return made;
}

std::string text_of(const Camera& camera) {
  return fmt::format("eye {} target {} up {} fov {} near {}", text_of(camera.eye),
                     text_of(camera.target), text_of(camera.up), float(camera.vertical_fov_degrees),
                     float(camera.near));
}

}  // namespace clpv
