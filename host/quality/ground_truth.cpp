// SPDX-License-Identifier: MIT
#include "quality/ground_truth.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cctype>
#include <optional>

#include "clpv/version.hpp"
#include "image/image_io.hpp"
#include "pathtracer/path_tracer.hpp"
#include "pipeline/raster/view.hpp"
#include "scene/emission.hpp"
#include "scene/sky.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/named_enum.hpp"
#include "support/output_file.hpp"

namespace clpv::reference {
namespace {

// Increment when the tracer's results change; this invalidates cached references.
constexpr int kTracerRevision = 1;

std::string key(const Scene& scene, const SceneCamera& camera, const ClpvView& view,
                const PathTracerOptions& options) {
  Fingerprint print;
  print.add(version()).add(kTracerRevision).add(scene_fingerprint(scene));
  for (const SceneLight& light : scene.lights_for(camera)) print.add(std::vector{light.data});
  print.add(std::vector{view}).add(options.bounces).add(options.seed).add(emits(scene));
  print.add(options.samples).add(options.samples > 0 ? 0.0 : options.noise);
  return print.hex();
}

/// Converts a name to a safe part of a file name; replaces other characters by '_'.
std::string in_file_name(std::string name) {
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
  }
  return name;
}

std::vector<Show> views_of(bool medium) {
  std::vector<Show> views(kSurfaceViews.begin(), kSurfaceViews.end());
  if (medium) views.push_back(Show::medium);
  return views;
}

Image all_views(const TracedImage& traced) {
  Image image;
  for (const Show show : views_of(traced.medium.has_value()))
    append_layer(image, traced_view(traced, show), std::string(name_of(show)));
  return image;
}

void describe(Image& image, const Scene& scene, const SceneCamera& camera, const TracedImage& traced,
              const PathTracerOptions& options) {
  image.metadata["command"] = "pathtrace";
  image.metadata["version"] = version();
  image.metadata["scene"] = scene.name;
  image.metadata["camera"] = camera.name;
  image.metadata["bounces"] =
      options.bounces == PathTracerOptions::kAllBounces ? "all" : std::to_string(options.bounces);
  image.metadata["seed"] = std::to_string(options.seed);
  image.metadata["spp_traced"] = std::to_string(traced.samples);
  image.metadata["noise_reached"] = fmt::format("{}", traced.noise);
}

GroundTruth read_reference(const std::filesystem::path& file, const Scene& scene) {
  GroundTruth truth;
  truth.image = read_image(file);
  truth.file = file;
  for (const Show show : views_of(scene.medium.has_value()))
    extract_layer(truth.image, std::string(name_of(show)), file.string());  // throws
  truth.samples = static_cast<std::uint32_t>(std::stoul(truth.image.metadata.at("spp_traced")));
  truth.noise = std::stod(truth.image.metadata.at("noise_reached"));
  return truth;
}

}  // namespace

std::string scene_fingerprint(const Scene& scene) {
  Fingerprint print;
  print.add(scene.vertices).add(scene.triangles).add(scene.materials);
  for (const Texture& texture : scene.textures) {
    print.add(texture.width).add(texture.height).add(texture.wrap_u).add(texture.wrap_v).add(texture.rgba);
  }
  if (scene.sky) add_sky(print, *scene.sky);
  if (scene.medium) print.add(*scene.medium);
  return print.hex();
}

namespace {

/// Returns the cached ground truth if its file is readable.
std::optional<GroundTruth> read_cached(const std::filesystem::path& file, const Scene& scene) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  try {
    return read_reference(file, scene);
  } catch (const std::exception& error) {
    spdlog::warn("{}; traced again", error.what());
    return std::nullopt;
  }
}

/// Returns false, with a warning, if the ground truth cannot be cached.
bool can_be_cached(const std::filesystem::path& file) {
  std::error_code failure;  // check_writable reports any error of the folder
  std::filesystem::create_directories(file.parent_path(), failure);
  try {
    check_writable(file);
    return true;
  } catch (const Error& error) {
    spdlog::warn("{}: the ground truth is not cached", error.what());
    return false;
  }
}

}  // namespace

GroundTruth cached_ground_truth(const std::filesystem::path& folder, const Scene& scene,
                                const SceneCamera& camera, int width, int height,
                                const PathTracerOptions& options, const TraceProgress& progress,
                                Ranks& ranks) {
  const ClpvView view = camera_view(camera, width, height);
  const std::filesystem::path file =
      folder / fmt::format("{}-{}-{}.exr", in_file_name(scene.name), in_file_name(camera.name),
                           key(scene, camera, view, options));
  std::optional<GroundTruth> kept;
  bool cached = false;
  const std::string found = ranks.from_root([&] {
    kept = read_cached(file, scene);
    if (!kept) cached = can_be_cached(file);
    return kept ? "there" : "";
  });
  if (!found.empty()) {
    GroundTruth truth = kept ? *std::move(kept) : read_reference(file, scene);
    truth.exposure = scene.exposure;
    return truth;
  }
  const TracedImage traced = trace_paths(scene, scene.lights_for(camera), view, options, progress, ranks);
  GroundTruth truth{all_views(traced), file, true, traced.samples, traced.noise, scene.exposure};
  describe(truth.image, scene, camera, traced, options);
  if (cached) write_exr(file, truth.image);  // at rank 0
  return truth;
}

}  // namespace clpv::reference
