// SPDX-License-Identifier: MIT
// Loads scene files and models, and adds a default camera and light.
#include "scene/load.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "scene/emission.hpp"
#include "scene/gltf_parts.hpp"
#include "scene/input.hpp"
#include "scene/sky.hpp"
#include "support/error.hpp"
#include "support/input_file.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

// Blender's 'Standard' export of lights writes lux and candela, 683 lm/W, in which a sun of 1 W/m^2
// and a lamp of 10 W exceed kPhotometric. In watts, a sun has up to 1361 W/m^2 and lamps far less.
constexpr double kLumensPerWatt = 683, kPhotometric = 500;
const std::string kBlenderUnits = fmt::format(
    "lights by Blender that look like lux and candela of {} lm/W: light scale {:.6f} (option "
    "light-scale) counts them in watts, as emission",
    kLumensPerWatt, 1 / kLumensPerWatt);

/// Returns true if Blender wrote the model, and one of its lights is too bright for watts.
bool looks_photometric(const GltfDocument& document, const SceneData& scene) {
  return document.model.asset.generator.find("Blender") != std::string::npos &&
         std::ranges::any_of(scene.lights, [](const SceneLight& light) {
           return *std::ranges::max_element(light.data.intensity) >= kPhotometric;
         });
}

/// Whether a model's cameras and lights are shown, and not those of a scene file.
struct OwnViews {
  bool cameras = true, lights = true;
};

/// Loads a .gltf or .glb at 0 s: geometry, materials, textures, cameras and lights, in metres and
/// without defaults. Stores animated meshes, cameras and lights in `motion`.
/// Notes name only what `own` says is shown.
SceneData load_gltf(const std::filesystem::path& path, double metres_per_unit, Motion& motion,
                    Notes& notes, OwnViews own = {}) {
  const GltfDocument document = read_gltf_document(path);
  std::vector<std::string> ignored = document.model.extensionsUsed;
  std::erase_if(ignored, reads_extension);
  if (!ignored.empty())
    notes.add(fmt::format("extensions that are not read: {}", fmt::join(ignored, ", ")));
  SceneData scene;
  motion.tree = read_nodes(document, read_animations(document, notes),
                           glm::scale(glm::dmat4(1.0), glm::dvec3(metres_per_unit)), notes);
  PosedTree posed(motion.tree, 0);
  const MaterialSet materials = read_materials(document, notes);
  auto textures =
      std::async(std::launch::async, [&] { return load_textures(document, materials.textures); });
  append_meshes(document, posed, materials, scene, motion, notes);  // concurrent with load_textures
  Notes unused;
  append_views(document, posed, metres_per_unit, scene, motion,
               {own.cameras ? notes : unused, own.lights ? notes : unused});
  if (own.lights && looks_photometric(document, scene)) notes.add(kBlenderUnits);
  scene.textures = textures.get();
  scene.materials = materials.materials;
  // GlTF's default material.
  const auto last = static_cast<std::uint32_t>(scene.materials.size() - 1);
  if (std::none_of(scene.triangles.begin(), scene.triangles.end(),
                   [&](auto& t) { return t.material == last; })) {
    scene.materials.pop_back();
  }
  return scene;
}

void find_bounds(SceneData& scene) {
  const Bounds box = bounds_of(scene.vertices);
  scene.lower = box.lower, scene.upper = box.upper;
}

/// Notes a scene so small that lamps cannot light it, which renders black.
void note_small_scene(const SceneData& scene, double metres_per_unit, Notes& notes) {
  const glm::vec3 extent = scene.upper - scene.lower;
  const float widest = std::max({extent.x, extent.y, extent.z});
  if (scene.triangles.empty() || widest >= bounds::kSmallScene) return;
  notes.add(fmt::format(
      "the scene is {:.2g} m wide, with metres_per_unit {}: much of it is dark, since lamps light "
      "nothing nearer than 0.01 m; allowed without this note: {} m or more",
      widest, metres_per_unit, bounds::kSmallScene));
}

void check_camera_lights(const SceneData& scene) {
  std::vector<std::string> names;
  for (const SceneLight& light : scene.lights) names.push_back("'" + light.name + "'");
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    if (!scene.cameras[i].light.empty() && !scene.has_light(scene.cameras[i].light)) {
      reject(scene.path, fmt::format("/cameras/{}/light", i), "'" + scene.cameras[i].light + "'",
             names.empty() ? "none, since there are no lights"
                           : fmt::format("{}", fmt::join(names, ", ")));
    }
  }
}

// Default light of a model without lights: a steep sun from behind and to the right of the default
// camera. With 10 lx, a white floor has radiance 3.2, so that diffuse walls fill the tone curve's
// range at exposure 0.
constexpr glm::vec3 kSunDirection{-0.35f, -0.85f, -0.4f};

// Default camera of a model without cameras: from above and the side, with the bounding sphere just
// within its view.
constexpr glm::vec3 kFramingDirection{-0.5f, -0.35f, -1.0f};  // viewing direction
constexpr float kFramingFov = static_cast<float>(std::numbers::pi) / 4;

SceneCamera framing_camera(const SceneData& scene) {
  SceneCamera camera;
  camera.name = "framing";
  camera.forward = glm::normalize(kFramingDirection);
  const glm::vec3 up(0, 1, 0);
  camera.up = glm::normalize(up - camera.forward * glm::dot(camera.forward, up));
  camera.vertical_fov = kFramingFov;
  const float radius = std::max(glm::length(scene.upper - scene.lower) / 2, 1e-3f);
  const float distance = radius / std::sin(kFramingFov / 2);
  camera.eye = (scene.lower + scene.upper) / 2.0f - camera.forward * distance;
  camera.near_depth = (distance - radius) / 2;
  return camera;
}

SceneLight added_sun() {
  SceneLight sun;
  sun.name = "sun";
  sun.data.kind = CLPV_LIGHT_DIRECTIONAL;
  const glm::vec3 direction = glm::normalize(kSunDirection);
  for (int i = 0; i < 3; ++i) {
    sun.data.direction[i] = direction[i];
    sun.data.intensity[i] = static_cast<float>(kSunIlluminance);
  }
  return sun;
}

const std::string kInMemory = "(in memory)";  // name and path of a scene without a file
const std::string kNoTriangles = "the model has no triangles",
                  kAddedCamera =
                      "no camera: added one outside, which sees a closed room's outer walls "
                      "(--eye, --target: another)",
                  kAddedSun = fmt::format("no light: added a sun of {} lux", kSunIlluminance);

}  // namespace

/// Adds a default camera and light, with a note each, to a scene whose bounding box is set.
/// `has_lights`: an empty list of lights is intended, and gets no default.
void MovingScene::add_defaults(bool has_lights) {
  if (scene_.triangles.empty()) scene_.notes.push_back(kNoTriangles);
  if (scene_.cameras.empty()) {
    scene_.cameras.push_back(framing_camera(scene_));
    scene_.notes.push_back(kAddedCamera);
  }
  if (scene_.lights.empty() && !has_lights) {
    scene_.lights.push_back(added_sun());
    scene_.light_scale = 1;
    scene_.notes.push_back(kAddedSun);
  }
}

void MovingScene::load_scene_file(const std::filesystem::path& path,
                                  const std::filesystem::path& replacement, Notes& notes) {
  description_ = read_scene_file(path);
  SceneViews views = views_at(description_, 0);
  InputRecord::add({path.string() + " /model", description_.model});
  const std::filesystem::path model = replacement.empty() ? description_.model : replacement;
  if (model.empty())
    reject(path.string(), "/model", "nothing",
           "a path to a .gltf or .glb, or option model (--model PATH)");
  std::error_code unknown;
  if (replacement.empty() && !std::filesystem::exists(model, unknown)) {
    reject(path.string(), "/model", "no file '" + model.string() + "'",
           "an existing file, or option model (--model PATH) with the path of one");
  }
  scene_ = load_gltf(model, description_.metres_per_unit, motion_, notes,
                     {!views.cameras, !views.lights});
  if (views.cameras) motion_.cameras.clear();
  if (views.lights) motion_.lights.clear();
  set_views(std::move(views));
  scene_.light_scale = description_.light_scale.value_or(1);
  scene_.exposure = description_.exposure;
  scene_.cascade_size = description_.cascade_size;
  scene_.cascades = description_.cascades;
  scene_.sky = description_.sky;
  if (scene_.sky)
    for (const std::string& note : scene_.sky->notes) notes.add(note);
  scene_.medium = description_.medium;
}

void MovingScene::set_views(SceneViews views) {
  if (views.cameras) scene_.cameras = std::move(*views.cameras);
  if (views.lights) scene_.lights = std::move(*views.lights);
}

void MovingScene::set_cameras(std::vector<SceneCamera> cameras) {
  motion_.cameras.clear();
  description_.cameras.reset();
  scene_.cameras = std::move(cameras);
  std::erase(scene_.notes, kAddedCamera);
  if (scene_.start_reach) {
    scene_.start_reach.reset();
    scene_.start_reach = scene_.reach();
  }
}

void MovingScene::set_lights(std::vector<SceneLight> lights) {
  motion_.lights.clear();
  description_.lights.reset();
  scene_.lights = std::move(lights);
  scene_.light_scale = 1;
  std::erase(scene_.notes, kAddedSun);
  std::erase(scene_.notes, kBlenderUnits);
}

void MovingScene::set_light_scale(double scale) {
  const bool added = std::ranges::find(scene_.notes, kAddedSun) != scene_.notes.end();
  if (added || scene_.lights.empty())
    throw Error(ExitCode::usage, "light-scale: found {}, allowed: none, since {} has no lights",
                scale, scene_.path);
  scene_.light_scale = static_cast<float>(scale);
  std::erase(scene_.notes, kBlenderUnits);
}

void MovingScene::set_medium(std::optional<ClpvMedium> medium) {
  scene_.medium = medium;
  medium_fills_scene_ = medium && vector(medium->lower) == vector(medium->upper);
  fit_medium();
}

bool MovingScene::fit_medium() {
  if (!medium_fills_scene_) return false;
  ClpvMedium& medium = *scene_.medium;
  const bool fits = vector(medium.lower) == glm::dvec3(scene_.lower) &&
                    vector(medium.upper) == glm::dvec3(scene_.upper);
  for (int i = 0; i < 3; ++i) {
    medium.lower[i] = scene_.lower[i];
    medium.upper[i] = scene_.upper[i];
  }
  return !fits;
}

MovingScene::MovingScene() {
  scene_.name = scene_.path = kInMemory;
  add_defaults(false);
}

MovingScene::MovingScene(const std::filesystem::path& path,
                         const std::filesystem::path& replacement) {
  Notes notes;
  const std::string extension = lower_extension(path);
  if (extension == ".json") {
    load_scene_file(path, replacement, notes);
    scene_.path = path.string();
  } else if (extension == ".gltf" || extension == ".glb") {
    const std::filesystem::path model = replacement.empty() ? path : replacement;
    scene_ = load_gltf(model, 1.0, motion_, notes);
    scene_.path = model.string();
  } else {
    reject(path.string(), {},
           extension.empty() ? "no extension" : "the extension '" + extension + "'",
           ".json (a scene file), .gltf or .glb");
  }
  if (motion_.empty()) motion_.tree = {};  // frees its memory
  for (const Instance& instance : motion_.meshes) scene_.moving.push_back(range_of(instance));
  find_bounds(scene_);
  note_small_scene(scene_, description_.metres_per_unit, notes);
  if (scene_.medium) set_medium(*scene_.medium);
  scene_.notes = notes.take();
  if (description_.light_scale) std::erase(scene_.notes, kBlenderUnits);
  const bool glows = std::ranges::any_of(
      scene_.materials, [](const ClpvMaterial& material) { return emits(material); });
  add_defaults(description_.lights.has_value() || scene_.sky || glows);
  check_camera_lights(scene_);
  if (moves()) scene_.start_reach = scene_.reach();
  scene_.name = printable(path.stem().string());  // JSON and metadata have UTF-8 only
}

bool MovingScene::change_meshes(const MeshChange& change) {
  const bool longer = change(added_, scene_);
  find_bounds(scene_);
  const bool refitted = fit_medium();
  std::erase(scene_.notes, kNoTriangles);
  if (scene_.triangles.empty()) scene_.notes.push_back(kNoTriangles);
  if (std::ranges::find(scene_.notes, kAddedCamera) != scene_.notes.end())
    scene_.cameras = {framing_camera(scene_)};
  if (scene_.start_reach) {
    scene_.start_reach.reset();
    scene_.start_reach = scene_.reach();
  }
  return longer || refitted;
}

void MovingScene::pose(double seconds) {
  motion_.pose(scene_, seconds);
  if (!motion_.meshes.empty()) find_bounds(scene_);
  if (!description_.moves()) return;
  set_views(views_at(description_, seconds));
}

SceneData load_scene(const std::filesystem::path& path, const std::filesystem::path& model) {
  return MovingScene(path, model).take();
}

bool is_bare_model(const SceneData& scene) {
  const std::string extension = lower_extension(scene.path);
  return extension == ".gltf" || extension == ".glb" || scene.path == kInMemory;
}

}  // namespace clpv
