// SPDX-License-Identifier: MIT
#include "scene/scene_file.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "scene/bounds.hpp"
#include "scene/input.hpp"
#include "scene/light_cone.hpp"
#include "scene/light_kind.hpp"
#include "support/error.hpp"
#include "support/json_schema.hpp"

namespace clpv {
namespace {

using nlohmann::json;

constexpr double kFar = bounds::kCoordinate;
constexpr double kTiny = 1e-6;   // stands for "greater than 0"
constexpr double kBright = 1e9;  // lux or candela; the sun is 1e5
constexpr double kRadians = std::numbers::pi / 180;
constexpr double kOuterCone = 45, kInnerCone = 0;  // [degrees] where not given, as in KHR_lights_punctual

const std::vector<Rule>& rules() {
  using namespace rule;
  static const std::vector<Rule> kRules = {
      object(""),
      text("/model"),
      number("/metres_per_unit", kTiny, 1e6),
      number("/exposure", -64, 64),
      list("/cameras", 0, bounds::kCameras),
      object("/cameras/*"),
      text("/cameras/*/name").must(),
      vector("/cameras/*/eye", 3, -kFar, kFar).must(),
      vector("/cameras/*/target", 3, -kFar, kFar).must(),
      vector("/cameras/*/up", 3, -kFar, kFar),
      number("/cameras/*/vertical_fov_degrees", 0.01, 179.9),
      number("/cameras/*/near", kTiny, kFar),
      text("/cameras/*/light"),
      list("/lights", 0, bounds::kLights),
      object("/lights/*"),
      text("/lights/*/name"),
      text("/lights/*/kind", names_of<LightKind>()).must(),
      vector("/lights/*/direction", 3, -kFar, kFar),
      vector("/lights/*/position", 3, -kFar, kFar),
      number("/lights/*/illuminance_lux", 0, kBright),
      number("/lights/*/intensity_candela", 0, kBright),
      vector("/lights/*/colour", 3, 0, kBright),
      number("/lights/*/inner_cone_degrees", 0, 90),
      number("/lights/*/outer_cone_degrees", kTiny, 90),
      number("/lights/*/range", kTiny, kFar),
      object("/cascades"),
      integer("/cascades/count", 1, 16),
      number("/cascades/size_metres", 1e-3, kFar),
      text("/comment"),
  };
  return kRules;
}

glm::dvec3 vector_in(const json& object, const char* key) {
  const json& v = object[key];
  return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()};
}

glm::dvec3 direction_in(const json& object, const char* key, const std::string& file,
                        const std::string& place) {
  const glm::dvec3 v = vector_in(object, key);
  if (glm::length(v) < kTiny) refuse(file, pointer_to(place, key), "a vector of no length", "a direction");
  return glm::normalize(v);
}

Camera read_camera(const json& given, double scale, const std::string& file, const std::string& place) {
  Camera made;
  made.name = given["name"];
  made.light = given.value("light", std::string());
  const glm::dvec3 eye = vector_in(given, "eye"), towards = vector_in(given, "target") - eye;
  if (glm::length(towards) < kTiny)
    refuse(file, place + "/target", "the eye itself", "a point away from eye");
  const glm::dvec3 forward = glm::normalize(towards);
  const glm::dvec3 up = given.contains("up") ? direction_in(given, "up", file, place) : glm::dvec3(0, 1, 0);
  const glm::dvec3 across = up - forward * glm::dot(forward, up);
  if (glm::length(across) < kTiny) {
    refuse(file, place + "/up",
           given.contains("up") ? "a vector along the line of sight" : "nothing, and a vertical view",
           "a vector across the line of sight");
  }
  made.eye = glm::vec3(eye * scale);
  made.forward = glm::vec3(forward);
  made.up = glm::vec3(glm::normalize(across));
  made.vertical_fov = static_cast<float>(given.value("vertical_fov_degrees", 60.0) * kRadians);
  if (given.contains("near")) made.near_depth = static_cast<float>(given["near"].get<double>() * scale);
  return made;
}

/// Keys of a light beyond name, kind and colour: which its kind must have, and which it may have.
struct LightKeys {
  std::vector<std::string> required, optional;
};

LightKeys keys_of(LightKind kind) {
  switch (kind) {
    case LightKind::directional:
      return {{"direction", "illuminance_lux"}, {}};
    case LightKind::spot:
      return {{"position", "direction", "intensity_candela"},
              {"range", "inner_cone_degrees", "outer_cone_degrees"}};
    case LightKind::point:
      return {{"position", "intensity_candela"}, {"range"}};
  }
  return {};
}

void check_light_keys(const json& given, LightKind light_kind, const std::string& file,
                      const std::string& place) {
  const LightKeys keys = keys_of(light_kind);
  const std::string kind(name_of(light_kind));
  for (const std::string& key : keys.required) {
    if (!given.contains(key))
      refuse(file, pointer_to(place, key), "nothing", "a value: a " + kind + " light needs it");
  }
  std::set<std::string> allowed = {"name", "kind", "colour"};
  allowed.insert(keys.required.begin(), keys.required.end());
  allowed.insert(keys.optional.begin(), keys.optional.end());
  for (const auto& [key, value] : given.items()) {
    if (!allowed.contains(key)) {
      refuse(file, pointer_to(place, key), "a key that a " + kind + " light has not",
             fmt::format("{}", fmt::join(allowed, ", ")));
    }
  }
}

Light read_light(const json& given, double scale, const std::string& file, const std::string& place) {
  const LightKind kind = named<LightKind>("kind", given["kind"].get_ref<const std::string&>());
  check_light_keys(given, kind, file, place);
  Light made;
  made.name = given.value("name", std::string());
  ClpvLight& data = made.data;
  data.kind = static_cast<unsigned>(kind);
  const double strength =
      given.value(given.contains("illuminance_lux") ? "illuminance_lux" : "intensity_candela", 0.0);
  const glm::dvec3 colour = given.contains("colour") ? vector_in(given, "colour") : glm::dvec3(1);
  const glm::dvec3 position =
      given.contains("position") ? vector_in(given, "position") * scale : glm::dvec3(0);
  const glm::dvec3 direction =
      given.contains("direction") ? direction_in(given, "direction", file, place) : glm::dvec3(0);
  for (int i = 0; i < 3; ++i) {
    data.intensity[i] = static_cast<float>(strength * colour[i]);
    data.position[i] = static_cast<float>(position[i]);
    data.direction[i] = static_cast<float>(direction[i]);
  }
  data.range = static_cast<float>(given.value("range", 0.0) * scale);
  if (kind == LightKind::spot) {
    const double inner = given.value("inner_cone_degrees", kInnerCone);
    const double outer = given.value("outer_cone_degrees", kOuterCone);
    if (inner >= outer) {
      refuse(file, place, fmt::format("inner_cone_degrees {} and outer_cone_degrees {}", inner, outer),
             "inner less than outer");
    }
    set_cone(data, inner * kRadians, outer * kRadians);
  }
  return made;
}

/// Names tell cameras and lights apart, so none may come twice. Nameless lights are fine.
template <typename Named>
void check_names(const std::vector<Named>& list, const std::string& file, const char* place) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list[i].name.empty() && !seen.insert(list[i].name).second) {
      refuse(file, fmt::format("{}/{}/name", place, i), "'" + list[i].name + "' again", "names that differ");
    }
  }
}

}  // namespace

SceneFile read_scene_file(const std::filesystem::path& path) {
  const std::string file = path.string();
  const Bytes bytes = read_file(path, bounds::kJsonBytes, file);
  const json parsed = parse_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
  check_rules(parsed, rules(), file);
  check_no_other_keys(parsed, rules(), file);

  SceneFile scene;
  if (parsed.contains("model")) {
    const std::string model = parsed["model"];
    if (model.empty() || model.find('\0') != std::string::npos)
      refuse(file, "/model", "no path", "a path to a model");
    scene.model = path.parent_path() / model;
  }
  scene.metres_per_unit = parsed.value("metres_per_unit", 1.0);
  scene.exposure = parsed.value("exposure", 0.0f);
  if (parsed.contains("cascades")) {
    const json& cascades = parsed["cascades"];
    if (cascades.contains("count")) scene.cascades = cascades["count"].get<int>();
    if (cascades.contains("size_metres")) scene.cascade_size = cascades["size_metres"].get<float>();
  }
  if (parsed.contains("cameras")) {
    scene.cameras.emplace();
    for (std::size_t i = 0; i < parsed["cameras"].size(); ++i) {
      scene.cameras->push_back(
          read_camera(parsed["cameras"][i], scene.metres_per_unit, file, fmt::format("/cameras/{}", i)));
    }
    check_names(*scene.cameras, file, "/cameras");
  }
  if (parsed.contains("lights")) {
    scene.lights.emplace();
    for (std::size_t i = 0; i < parsed["lights"].size(); ++i) {
      scene.lights->push_back(
          read_light(parsed["lights"][i], scene.metres_per_unit, file, fmt::format("/lights/{}", i)));
    }
    check_names(*scene.lights, file, "/lights");
  }
  return scene;
}

}  // namespace clpv
