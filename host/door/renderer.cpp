// SPDX-License-Identifier: MIT
#include "clpv/renderer.hpp"

#include <nlohmann/json.hpp>

#include "door/scene_contents.hpp"
#include "image/image.hpp"
#include "pipeline/frame.hpp"
#include "pipeline/given_options.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

/// Without a default: a view that is not listed does not compile.
Show shown(View view) {
  switch (view) {
    case View::full:
      return Show::full;
    case View::direct:
      return Show::direct;
    case View::indirect:
      return Show::indirect;
    case View::irradiance:
      return Show::irradiance;
    case View::albedo:
      return Show::albedo;
    case View::normal:
      return Show::normal;
    case View::depth:
      return Show::depth;
  }
  throw Error(ExitCode::usage, "view {}: allowed: 0..{}", static_cast<int>(view),
              static_cast<int>(View::depth));
}

}  // namespace

struct Renderer::State {
  SceneFile scene;
  RenderOptions options;
  Session session;
  Tuning tuning;
  Frame frame;

  State(const SceneFile& file, const Options& given, const std::string& device)
      : scene(file),
        options(resolve_options(given.given(), file.contents().scene)),
        session(choose_device(device), ProgramCache::of_user()),
        tuning(tuning_for(session.device(), options, !given.given().contains("layout"))),
        frame(session, scene.contents().scene, options, tuning) {}
};

Renderer::Renderer(const SceneFile& scene, const Options& options, const std::string& device)
    : state_(std::make_unique<State>(scene, options, device)) {}

Renderer::~Renderer() {
  if (!state_) return;
  try {
    state_->session.store_programs();
  } catch (const std::exception& error) {  // a cache is never a reason to fail
    spdlog::debug("compiled programs are not kept: {}", error.what());
  }
}

Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Image Renderer::render(View view, const std::string& camera) {
  const Show wanted = shown(view);
  const Camera& seen_by = state_->scene.contents().scene.camera(camera);
  state_->frame.render(seen_by);
  Image image = make_image(state_->options.width, state_->options.height, {"R", "G", "B", "A"});
  image.pixels = state_->frame.read(wanted);
  for (const OptionInfo& option : list_options(state_->options)) image.metadata[option.name] = option.value;
  image.metadata["camera"] = seen_by.name;
  return image;
}

}  // namespace clpv
