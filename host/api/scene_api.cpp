// SPDX-License-Identifier: MIT
// Implements clpv/scene.hpp.

#include <cmath>
#include <mutex>
#include <set>
#include <utility>

#include "api/scene_contents.hpp"
#include "clpv/device.hpp"
#include "clpv/image.hpp"
#include "clpv/options.hpp"
#include "device/device.hpp"
#include "image/compare.hpp"
#include "image/image_io.hpp"
#include "image/tone_map.hpp"
#include "options/render_options.hpp"
#include "scene/bounds.hpp"
#include "scene/load.hpp"
#include "support/error.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

/// Converts a list of cameras or lights; messages name the list and the index.
template <typename To, typename From, typename Convert>
std::vector<To> converted(const char* list, const std::vector<From>& given, std::size_t maximum,
                          const Convert& convert) {
  if (given.size() > maximum)
    throw Error(ExitCode::usage, "{}: found {} of them, allowed: at most {}", list, given.size(),
                maximum);
  std::vector<To> made;
  std::set<std::string> names;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const std::string place = fmt::format("{}[{}]", list, i);
    made.push_back(convert(given[i], rejected_in(place), 1.0));
    if (!given[i].name.empty() && !names.insert(given[i].name).second)
      throw Error(ExitCode::usage, "{}: name: found duplicate '{}', allowed: unique names", place,
                  given[i].name);
  }
  return made;
}

void check_time(double seconds) {
  if (std::abs(seconds) <= bounds::kSeconds) return;  // rejects NaN too
  throw Error(ExitCode::usage, "time: found {}, allowed: {}..{}", seconds, -bounds::kSeconds,
              bounds::kSeconds);
}

SceneCamera camera_in(const SceneData& scene, const CameraChoice& choice) {
  if (const auto* name = std::get_if<std::string>(&choice)) return scene.camera(*name);
  const Camera& given = std::get<Camera>(choice);
  SceneCamera made = scene_camera(given, rejected_in("camera"));
  made.name = text_of(given);
  if (!made.light.empty() && !scene.has_light(made.light)) {
    throw Error(ExitCode::usage, "camera: light: found '{}', allowed: a light of the scene",
                made.light);
  }
  return made;
}

}  // namespace

Scene::Scene() : contents_(std::make_shared<Contents>()) {}

Scene::Scene(const std::filesystem::path& path, const std::filesystem::path& model)
    : contents_(std::make_shared<Contents>(path, model)) {}

std::vector<Camera> Scene::cameras() const {
  const std::shared_lock lock(contents_->mutex);
  if (contents_->given.cameras) return *contents_->given.cameras;
  std::vector<Camera> all;
  for (const SceneCamera& camera : contents_->moving.scene().cameras)
    all.push_back(camera_of(camera));
  return all;
}

std::vector<Light> Scene::lights() const {
  const std::shared_lock lock(contents_->mutex);
  if (contents_->given.lights) return *contents_->given.lights;
  std::vector<Light> all;
  const SceneData& scene = contents_->moving.scene();
  for (const SceneLight& light : scene.lights) {
    Light& made = all.emplace_back(light_of(light));
    for (double& channel : made.intensity) channel *= scene.light_scale;
  }
  return all;
}

void Scene::set_cameras(const std::vector<Camera>& cameras) {
  if (cameras.empty()) throw Error(ExitCode::usage, "cameras: found none, allowed: at least one");
  std::vector<SceneCamera> made =
      converted<SceneCamera>("cameras", cameras, bounds::kCameras, scene_camera);
  const std::lock_guard lock(contents_->mutex);
  ++contents_->changes;
  contents_->cameras = made, contents_->given.cameras = cameras;
  contents_->moving.set_cameras(std::move(made));
}

void Scene::set_lights(const std::vector<Light>& lights) {
  std::vector<SceneLight> made =
      converted<SceneLight>("lights", lights, bounds::kLights, scene_light);
  const std::lock_guard lock(contents_->mutex);
  ++contents_->changes;
  contents_->lights = made, contents_->given.lights = lights;
  contents_->moving.set_lights(std::move(made));
}

std::optional<Medium> Scene::medium() const {
  const std::shared_lock lock(contents_->mutex);
  if (contents_->given.medium) return *contents_->given.medium;
  const std::optional<ClpvMedium>& medium = contents_->moving.scene().medium;
  if (!medium) return std::nullopt;
  Medium made = medium_of(*medium);
  if (contents_->moving.medium_fills_scene()) made.box.reset();
  return made;
}

void Scene::set_medium(const std::optional<Medium>& medium) {
  std::optional<ClpvMedium> made;
  if (medium) made = scene_medium(*medium, rejected_in("medium"));
  const std::lock_guard lock(contents_->mutex);
  contents_->moving.set_medium(made);
  contents_->given.medium = medium;
  ++contents_->rebuilds, ++contents_->changes;
}

void Scene::set_sky(const Vec3& above, const Vec3& below) {
  contents_->change_sky(scene_sky(above, below, rejected_in("sky")));
}

void Scene::set_sky_map(const std::filesystem::path& map, double scale, double degrees) {
  contents_->change_sky(scene_sky(map, scale, degrees, rejected_in("sky")));
}

int Scene::add_mesh(const Mesh& mesh, const Transform& transform) {
  int number = 0;
  contents_->change_meshes([&](AddedMeshes& meshes, SceneData& scene) {
    number = meshes.add(mesh, transform, scene);
    return true;
  });
  return number;
}

int Scene::add_instance(int mesh, const Transform& transform) {
  int number = 0;
  contents_->change_meshes([&](AddedMeshes& meshes, SceneData& scene) {
    number = meshes.add_instance(mesh, transform, scene);
    return true;
  });
  return number;
}

void Scene::remove_mesh(int mesh) {
  contents_->change_meshes([&](AddedMeshes& meshes, SceneData& scene) {
    meshes.remove(mesh, scene);
    return true;
  });
}

void Scene::set_positions(int mesh, std::span<const std::array<float, 3>> positions,
                          std::span<const std::array<float, 3>> normals) {
  contents_->change_meshes([&](AddedMeshes& meshes, SceneData& scene) {
    return meshes.set_positions(mesh, positions, normals, scene);
  });
}

void Scene::set_transform(int mesh, const Transform& transform) {
  contents_->change_meshes([&](AddedMeshes& meshes, SceneData& scene) {
    return meshes.set_transform(mesh, transform, scene);
  });
}

void Scene::save(const std::filesystem::path& path) const {
  const std::shared_lock lock(contents_->mutex);
  write_glb(path, contents_->moving.scene());
}

bool Scene::moves() const {
  const std::shared_lock lock(contents_->mutex);
  return contents_->moving.moves();
}

std::vector<std::string> Scene::notes() const {
  const std::shared_lock lock(contents_->mutex);
  return contents_->moving.scene().notes;
}

std::array<Vec3, 2> Scene::bounds() const {
  const std::shared_lock lock(contents_->mutex);
  const glm::vec3 &lower = contents_->moving.scene().lower,
                  &upper = contents_->moving.scene().upper;
  return {{{lower.x, lower.y, lower.z}, {upper.x, upper.y, upper.z}}};
}

std::optional<float> Scene::exposure() const {
  const std::shared_lock lock(contents_->mutex);
  return contents_->moving.scene().exposure;
}

PosedScene::PosedScene(const Scene& file)
    : file_(file),
      posed_(file.contents().moving.moves() ? std::optional(file.contents().moving) : std::nullopt),
      geometries_(file.contents().geometries) {}

bool PosedScene::pose(double seconds) {
  check_time(seconds);
  const Scene::Contents& shared = file_.contents();
  const bool changed = std::exchange(geometries_, shared.geometries) != shared.geometries;
  if (!posed_) return changed;
  if (changed) posed_ = shared.moving;
  if (const auto& cameras = file_.contents().cameras) posed_->set_cameras(*cameras);
  if (const auto& lights = file_.contents().lights) posed_->set_lights(*lights);
  posed_->set_medium(file_.contents().moving.scene().medium);
  posed_->set_sky(file_.contents().moving.scene().sky);
  posed_->pose(seconds);
  return true;
}

SceneCamera PosedScene::camera(const CameraChoice& choice) const {
  return camera_in(scene(), choice);
}

void PosedScene::check(const CameraChoice& choice, double seconds) const {
  check_time(seconds);
  camera_in(file_.contents().moving.scene(), choice);
}

// Implements devices, images and options of the public interface.

std::vector<DeviceDescription> all_devices() {
  std::vector<DeviceDescription> all;
  for (const Device& device : list_devices().devices)
    all.push_back(
        {device.index, device.name, device.platform, device.driver, device.type, device.missing});
  return all;
}

void save_image(const std::filesystem::path& path, const Image& image, std::optional<float> given) {
  check_image("image", image);
  const float exposure = given ? *given : automatic_exposure(image);
  check_exposure(exposure);
  const std::string extension = lower_extension(path);
  if (extension == ".exr") {
    require_linear("image", image);
    return write_exr(path, image);
  }
  if (extension == ".png") return write_png(path, display_image(image, exposure, kDisplayCurve));
  throw Error(ExitCode::usage, "{}: found extension '{}', allowed: .exr, .png", path.string(),
              path.extension().string());
}

Options& Options::set(std::string_view name, std::string_view value) {
  RenderOptions probe;
  set_option(probe, name, value);
  given_[std::string(name)] = value;
  return *this;
}

std::vector<OptionDescription> Options::all() {
  return list_options(RenderOptions{});
}

Comparison compare(const Image& a, const Image& b, float exposure) {
  check_image("the image", a);
  check_image("its reference", b);
  check_exposure(exposure);
  return compare(a, "the image", b, "its reference", exposure);
}

}  // namespace clpv
