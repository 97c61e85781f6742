// SPDX-License-Identifier: MIT
// Reads and checks scene files.
#include "scene/scene_file.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "scene/bounds.hpp"
#include "scene/input.hpp"
#include "scene/scene.hpp"
#include "scene/sky.hpp"
#include "scene/view_values.hpp"
#include "support/error.hpp"
#include "support/json_schema.hpp"

namespace clpv {
namespace {

using nlohmann::json;

constexpr double kFar = bounds::kCoordinate;
constexpr double kTiny = 1e-6;   // minimum of positive numbers
constexpr double kBright = 1e9;  // maximum of lights [lux, candela]; the sun has 1e5 lux
constexpr double kRadians = std::numbers::pi / 180;

const KeyedList& keyed_cameras() {
  using namespace rule;
  static const KeyedList kList = {
      "/cameras",
      {vector("/cameras/*/eye", 3, -kFar, kFar), vector("/cameras/*/target", 3, -kFar, kFar),
       vector("/cameras/*/up", 3, -kFar, kFar),
       number("/cameras/*/vertical_fov_degrees", 0.01, 179.9)},
      "",
      {KeyInterpolation::linear, KeyInterpolation::step, KeyInterpolation::smooth}};
  return kList;
}

const KeyedList& keyed_lights() {
  using namespace rule;
  static const KeyedList kList = {
      "/lights",
      {vector("/lights/*/direction", 3, -kFar, kFar), vector("/lights/*/position", 3, -kFar, kFar),
       number("/lights/*/illuminance_lux", 0, kBright),
       number("/lights/*/intensity_candela", 0, kBright),
       vector("/lights/*/colour", 3, 0, kBright)},
      "direction",
      {KeyInterpolation::linear, KeyInterpolation::step}};
  return kList;
}

/// Rules of cameras and lights without keys.
std::vector<Rule> camera_and_light_rules() {
  using namespace rule;
  std::vector<Rule> rules = {
      list("/cameras", 0, bounds::kCameras),
      object("/cameras/*"),
      text("/cameras/*/name").must(),
      number("/cameras/*/near", kTiny, kFar),
      text("/cameras/*/light"),
      list("/lights", 0, bounds::kLights),
      object("/lights/*"),
      text("/lights/*/name"),
      text("/lights/*/kind", names_of<LightKind>()).must(),
      number("/lights/*/inner_cone_degrees", 0, 90),
      number("/lights/*/outer_cone_degrees", kTiny, 90),
      number("/lights/*/range", kTiny, kFar),
  };
  for (const KeyedList* keyed : {&keyed_cameras(), &keyed_lights()})
    rules.insert(rules.end(), keyed->quantities.begin(), keyed->quantities.end());
  return rules;
}

/// Rules of a scene file.
const std::vector<Rule>& rules() {
  using namespace rule;
  static const std::vector<Rule> kRules = [] {
    std::vector<Rule> all = {
        object(""),
        text("/model"),
        number("/metres_per_unit", kTiny, 1e6),
        number("/exposure", -64, 64),
        number("/light_scale", 1 / bounds::kLightScale, bounds::kLightScale),
        object("/cascades"),
        integer("/cascades/count", 1, 8),
        number("/cascades/size_metres", 1e-3, kFar),
        text("/comment"),
        object("/sky"),
        vector("/sky/radiance", 3, 0, bounds::kSkyRadiance),
        vector("/sky/ground", 3, 0, bounds::kSkyRadiance),
        text("/sky/map"),
        number("/sky/scale", 0, kBright),
        number("/sky/rotation_degrees", -360, 360),
        object("/medium"),
        vector("/medium/scattering", 3, 0, bounds::kExtinction),
        vector("/medium/absorption", 3, 0, bounds::kExtinction),
        number("/medium/anisotropy", -bounds::kAnisotropy, bounds::kAnisotropy),
        object("/medium/box"),
        vector("/medium/box/lower", 3, -kFar, kFar).must(),
        vector("/medium/box/upper", 3, -kFar, kFar).must(),
    };
    for (const std::vector<Rule>& more :
         {camera_and_light_rules(), key_rules(keyed_cameras()), key_rules(keyed_lights())})
      all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return kRules;
}

glm::dvec3 vector_in(const json& object, const char* key) {
  const json& v = object[key];
  return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()};
}

Vec3 numbers_in(const json& object, const char* key, const Vec3& fallback) {
  return object.contains(key) ? object[key].get<Vec3>() : fallback;
}

/// Rejects a member of an entry of the file.
RejectMember rejected_at(const std::string& file, const std::string& place) {
  return [&file, place](const std::string& member, const std::string& found,
                        const std::string& allowed) {
    reject(file, member.empty() ? place : pointer_to(place, member), found, allowed);
  };
}

SceneCamera read_camera(const json& given, double scale, const std::string& file,
                        const std::string& place) {
  for (const char* key : {"eye", "target"}) {
    if (!given.contains(key))
      reject(file, pointer_to(place, key), "nothing", "a point, here or in keys");
  }
  Camera camera;
  camera.name = given["name"];
  camera.light = given.value("light", std::string());
  camera.eye = given["eye"].get<Vec3>();
  camera.target = given["target"].get<Vec3>();
  camera.up = numbers_in(given, "up", camera.up);
  camera.vertical_fov_degrees = given.value("vertical_fov_degrees", camera.vertical_fov_degrees);
  if (given.contains("near")) camera.near = given["near"];
  SceneCamera made = scene_camera(camera, rejected_at(file, place), scale);
  if (!given.contains("near"))
    made.near_depth = static_cast<float>(Camera{}.near);  // [m] in any unit
  return made;
}

/// Rejects a light that lacks a key of its kind, or has one of another kind.
void check_light_keys(const json& given, const std::string& file, const std::string& place) {
  using Keys = std::set<std::string>;
  static const std::map<std::string, std::pair<Keys, Keys>> kKeys{
      // required, and optional
      {"directional", {{"direction", "illuminance_lux"}, {}}},
      {"spot",
       {{"position", "direction", "intensity_candela"},
        {"range", "inner_cone_degrees", "outer_cone_degrees"}}},
      {"point", {{"position", "intensity_candela"}, {"range"}}}};
  const std::string kind = given["kind"];
  const auto& [required, optional] = kKeys.at(kind);
  Keys allowed{"name", "kind", "colour"};
  allowed.insert(optional.begin(), optional.end());
  for (const std::string& key : required) {
    if (!given.contains(key))
      reject(file, pointer_to(place, key), "nothing", "a value: a " + kind + " light needs it");
    allowed.insert(key);
  }
  for (const auto& [key, value] : given.items()) {
    if (!allowed.contains(key)) {
      reject(file, pointer_to(place, key), "a key that a " + kind + " light does not have",
             fmt::format("{}", fmt::join(allowed, ", ")));
    }
  }
}

SceneLight read_light(const json& given, double scale, const std::string& file,
                      const std::string& place) {
  Light light;
  light.kind = named<LightKind>("kind", given["kind"].get_ref<const std::string&>());
  check_light_keys(given, file, place);
  light.name = given.value("name", std::string());
  const double strength =
      given.value(given.contains("illuminance_lux") ? "illuminance_lux" : "intensity_candela", 0.0);
  light.intensity = numbers_in(given, "colour", {1, 1, 1});
  for (double& channel : light.intensity) channel *= strength;
  light.position = numbers_in(given, "position", {});
  light.direction = numbers_in(given, "direction", {});
  light.range = given.value("range", 0.0);
  light.inner_cone_degrees = given.value("inner_cone_degrees", light.inner_cone_degrees);
  light.outer_cone_degrees = given.value("outer_cone_degrees", light.outer_cone_degrees);
  return scene_light(light, rejected_at(file, place), scale);
}

/// Rejects duplicate names of cameras or lights. Empty names may repeat.
template <typename Named>
void check_names(const std::vector<Named>& list, const std::string& file, const char* place) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list[i].name.empty() && !names.insert(list[i].name).second) {
      reject(file, fmt::format("{}/{}/name", place, i), "duplicate name '" + list[i].name + "'",
             "unique names");
    }
  }
}

/// Reads each entry of a list by `read`.
template <typename Read>
auto read_list(const json& list, Read read, double scale, const std::string& file,
               const char* place) {
  std::vector<decltype(read(list, scale, file, file))> made;
  for (std::size_t i = 0; i < list.size(); ++i)
    made.push_back(read(list[i], scale, file, fmt::format("{}/{}", place, i)));
  check_names(made, file, place);
  return made;
}

std::optional<std::vector<KeyedEntry>> read_entries(const json& document, const char* key,
                                                    const KeyedList& list,
                                                    const std::string& file) {
  if (!document.contains(key)) return std::nullopt;
  std::vector<KeyedEntry> entries;
  for (std::size_t i = 0; i < document[key].size(); ++i)
    entries.emplace_back(document[key][i], list, file, fmt::format("{}/{}", list.place, i));
  return entries;
}

json entries_at(const std::vector<KeyedEntry>& entries, double seconds) {
  json list = json::array();
  for (const KeyedEntry& entry : entries) list.push_back(entry.at(seconds));
  return list;
}

/// Reads a sky: a constant, or a map in the scene file's folder or below.
Sky read_sky_member(const json& given, const std::filesystem::path& path, const std::string& file) {
  if (given.contains("radiance") == given.contains("map")) {
    reject(file, "/sky", given.contains("map") ? "radiance and map" : "neither radiance nor map",
           "one of them");
  }
  if (given.contains("radiance")) {
    for (const char* key : {"scale", "rotation_degrees"}) {
      if (given.contains(key))
        reject(file, pointer_to("/sky", key), "a value", "none, for a constant sky");
    }
    const glm::vec3 above(vector_in(given, "radiance"));
    return given.contains("ground") ? sky_with_ground(above, glm::vec3(vector_in(given, "ground")))
                                    : constant_sky(above);
  }
  if (given.contains("ground")) reject(file, "/sky/ground", "a value", "none, for a map");
  // The absolute path has a folder for bare file names too.
  const auto folder = std::filesystem::canonical(std::filesystem::absolute(path).parent_path());
  return read_sky(resolve_uri(folder, given["map"], file, "/sky/map"), given.value("scale", 1.0),
                  given.value("rotation_degrees", 0.0) * kRadians);
}

/// Reads a medium. Without a box its bounds are empty: they become those of the scene.
ClpvMedium read_medium(const json& given, double scale, const std::string& file) {
  if (!given.contains("scattering") && !given.contains("absorption"))
    reject(file, "/medium", "neither scattering nor absorption", "at least one of them");
  Medium medium{numbers_in(given, "scattering", {}),
                numbers_in(given, "absorption", {}),
                given.value("anisotropy", 0.0),
                {}};
  if (given.contains("box"))
    medium.box = {numbers_in(given["box"], "lower", {}), numbers_in(given["box"], "upper", {})};
  return scene_medium(medium, rejected_at(file, "/medium"), scale);
}

}  // namespace

bool SceneDescription::moves() const {
  const auto any = [](const auto& entries) {
    return entries &&
           std::any_of(entries->begin(), entries->end(), [](auto& entry) { return entry.moves(); });
  };
  return any(cameras) || any(lights);
}

SceneDescription read_scene_file(const std::filesystem::path& path) {
  SceneDescription scene;
  scene.file = path.string();
  const json parsed = read_json(path);
  check_rules(parsed, rules(), scene.file);
  check_no_other_keys(parsed, rules(), scene.file);
  if (parsed.contains("model")) {
    const std::string model = parsed["model"];
    if (model.empty() || model.find('\0') != std::string::npos)
      reject(scene.file, "/model", "no path", "a path to a model");
    scene.model = path.parent_path() / model;
  }
  scene.metres_per_unit = parsed.value("metres_per_unit", 1.0);
  if (parsed.contains("exposure")) scene.exposure = parsed["exposure"].get<float>();
  if (parsed.contains("light_scale")) scene.light_scale = parsed["light_scale"].get<float>();
  if (parsed.contains("cascades")) {
    const json& cascades = parsed["cascades"];
    if (cascades.contains("count")) scene.cascades = cascades["count"].get<int>();
    if (cascades.contains("size_metres")) scene.cascade_size = cascades["size_metres"].get<float>();
  }
  if (parsed.contains("sky")) {
    scene.sky = std::make_shared<const Sky>(read_sky_member(parsed["sky"], path, scene.file));
    if (parsed["sky"].contains("map"))
      scene.sky_map = path.parent_path() / parsed["sky"]["map"].get<std::string>();
  }
  if (parsed.contains("medium"))
    scene.medium = read_medium(parsed["medium"], scene.metres_per_unit, scene.file);
  scene.cameras = read_entries(parsed, "cameras", keyed_cameras(), scene.file);
  scene.lights = read_entries(parsed, "lights", keyed_lights(), scene.file);
  return scene;
}

SceneViews views_at(const SceneDescription& description, double seconds) {
  const bool moves = description.moves();
  const std::string file =
      moves ? fmt::format("{} at {} s", description.file, seconds) : description.file;
  json posed = json::object();
  if (description.cameras) posed["cameras"] = entries_at(*description.cameras, seconds);
  if (description.lights) posed["lights"] = entries_at(*description.lights, seconds);
  if (moves)
    check_rules(posed, camera_and_light_rules(),
                file);  // splines may exceed the range of their keys
  const double scale = description.metres_per_unit;
  SceneViews made;
  if (description.cameras)
    made.cameras = read_list(posed["cameras"], read_camera, scale, file, "/cameras");
  if (description.lights)
    made.lights = read_list(posed["lights"], read_light, scale, file, "/lights");
  return made;
}

}  // namespace clpv
