// SPDX-License-Identifier: MIT
// Implements the public interface in include/clpv/.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "clpv/device.hpp"
#include "clpv/image.hpp"
#include "clpv/options.hpp"
#include "clpv/renderer.hpp"
#include "clpv/scene.hpp"
#include "device/device.hpp"
#include "image/image_io.hpp"
#include "image/tone_map.hpp"
#include "options/render_options.hpp"
#include "pipeline/frame.hpp"
#include "pipeline/scene_options.hpp"
#include "quality/light_field.hpp"
#include "scene/bounds.hpp"
#include "scene/load.hpp"
#include "support/error.hpp"
#include "support/log.hpp"

namespace clpv {

std::vector<DeviceDescription> all_devices() {
  std::vector<DeviceDescription> all;
  for (const Device& device : list_devices().devices)
    all.push_back({device.index, device.name, device.platform, device.driver, device.type, device.missing});
  return all;
}

void save_image(const std::filesystem::path& path, const Image& image, float exposure) {
  const std::string extension = path.extension().string();
  if (extension == ".exr") return write_exr(path, image);
  if (extension == ".png") return write_png(path, display_image(image, exposure, ToneMap::aces));
  throw Error(ExitCode::usage, "{}: found extension '{}', allowed: .exr, .png", path.string(), extension);
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

struct SceneFile::Contents {
  MovingScene moving;  ///< at 0 s
};

SceneFile::SceneFile(const std::filesystem::path& path, const std::filesystem::path& model)
    : contents_(std::make_shared<const Contents>(Contents{MovingScene(path, model)})) {}

std::vector<std::string> SceneFile::cameras() const {
  std::vector<std::string> names;
  for (const Camera& camera : contents_->moving.scene().cameras) names.push_back(camera.name);
  return names;
}

bool SceneFile::moves() const {
  return contents_->moving.moves();
}

std::vector<std::string> SceneFile::notes() const {
  return contents_->moving.scene().notes;
}

struct Renderer::State {
  SceneFile file;
  std::optional<MovingScene> posed;  ///< this renderer's copy of a scene that moves
  RenderOptions options;
  Session session;
  Frame frame;
  std::optional<LightField> light;  ///< light of the last frame, built by irradiance()

  State(const SceneFile& scene_file, const Options& given, const std::string& device)
      : file(scene_file),
        posed(scene_file.moves() ? std::optional(scene_file.contents().moving) : std::nullopt),
        options(resolve_options(given.given(), scene())),
        session(choose_device(device), ProgramCache::of_user()),
        frame(session, scene(), options) {}

  const Scene& scene() const { return posed ? posed->scene() : file.contents().moving.scene(); }

  void pose(double seconds) {
    if (!(std::abs(seconds) <= bounds::kSeconds)) {  // rejects NaN too
      throw Error(ExitCode::usage, "seconds: found {}, allowed: {}..{}", seconds, -bounds::kSeconds,
                  bounds::kSeconds);
    }
    if (!posed) return;
    posed->pose(seconds);
    frame.scene_moved();
  }
};

Renderer::Renderer(const SceneFile& scene, const Options& options, const std::string& device)
    : state_(std::make_unique<State>(scene, options, device)) {}

Renderer::~Renderer() {
  if (!state_) return;
  try {
    state_->session.store_programs();
  } catch (const std::exception& error) {  // a cache never makes the program fail
    spdlog::debug("compiled programs not cached: {}", error.what());
  }
}

Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Image Renderer::render(View view, const std::string& camera, double seconds) {
  if (name_of(view).empty())
    throw Error(ExitCode::usage, "view: found {}, allowed: 0..{}", static_cast<int>(view),
                static_cast<int>(View::depth));
  state_->light.reset();
  state_->pose(seconds);
  const Camera& chosen = state_->scene().camera(camera);
  state_->frame.render(chosen);
  Image image = view_image(state_->frame, view);
  for (const OptionDescription& option : list_options(state_->options))
    image.metadata[option.name] = option.value;
  image.metadata["camera"] = chosen.name;
  image.metadata["time"] = fmt::format("{}", seconds);
  return image;
}

std::array<double, 3> Renderer::irradiance(const std::array<double, 3>& position,
                                           const std::array<double, 3>& normal) {
  const glm::dvec3 at(position[0], position[1], position[2]), n(normal[0], normal[1], normal[2]);
  const double length = glm::length(n);
  if (!(length > 0 && std::isfinite(length)) || !std::isfinite(at.x + at.y + at.z)) {
    throw Error(ExitCode::usage,
                "irradiance: found position ({}, {}, {}) and normal ({}, {}, {}), allowed: finite numbers, a "
                "nonzero normal",
                at.x, at.y, at.z, n.x, n.y, n.z);
  }
  if (!state_->light) state_->light.emplace(state_->session, state_->frame);
  const glm::dvec3 e = state_->light->irradiance(at, n / length);
  return {e.x, e.y, e.z};
}

}  // namespace clpv
