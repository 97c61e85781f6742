// SPDX-License-Identifier: MIT
#include "quality/ground_truth.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <optional>

#include "clpv/version.hpp"
#include "image/image_io.hpp"
#include "pathtracer/path_tracer.hpp"
#include "pipeline/raster/view.hpp"
#include "scene/emission.hpp"
#include "scene/sky.hpp"
#include "support/cache_folder.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/named_enum.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

// Increment when the tracer's results change; this invalidates cached references.
constexpr int kTracerRevision = 1;

std::string key(const SceneData& scene, const SceneCamera& camera, const ClpvView& view,
                const pathtracer::PathTracerOptions& options) {
  Fingerprint print;
  print.add(version()).add(kTracerRevision).add(scene_fingerprint(scene));
  for (const SceneLight& light : scene.lights_for(camera)) print.add(std::vector{light.data});
  print.add(std::vector{view}).add(options.bounces).add(options.seed).add(emits(scene));
  print.add(options.samples).add(options.samples > 0 ? 0.0 : options.noise);
  return print.hex();
}

std::vector<Show> views_of(bool medium) {
  std::vector<Show> views(kSurfaceViews.begin(), kSurfaceViews.end());
  if (medium) views.push_back(Show::medium);
  return views;
}

Image all_views(const pathtracer::TracedImage& traced) {
  Image image;
  for (const Show show : views_of(traced.medium.has_value()))
    append_layer(image, pathtracer::traced_view(traced, show), std::string(name_of(show)));
  return image;
}

void describe(Image& image, const SceneData& scene, const SceneCamera& camera,
              const pathtracer::TracedImage& traced, const pathtracer::PathTracerOptions& options) {
  image.metadata["command"] = "pathtrace";
  image.metadata["version"] = version();
  image.metadata["scene"] = scene.name;
  image.metadata["camera"] = camera.name;
  image.metadata["bounces"] = options.bounces == pathtracer::PathTracerOptions::kAllBounces
                                  ? "all"
                                  : std::to_string(options.bounces);
  image.metadata["seed"] = std::to_string(options.seed);
  image.metadata["spp_traced"] = std::to_string(traced.samples);
  image.metadata["noise_reached"] = fmt::format("{}", traced.noise);
}

constexpr const char* kCacheFingerprint = "fingerprint";  // metadata: of the rest of a cached image

std::string fingerprint_of(const Image& image) {
  Fingerprint print;
  print.add(image.width).add(image.height);
  std::map<std::string, std::size_t> sorted;  // files order channels by name
  for (const std::string& name : image.channels) sorted[name] = *image.channel(name);
  for (const auto& [name, channel] : sorted) {
    std::vector<float> values(image.pixel_count());
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = image.pixels[i * image.channels.size() + channel];
    print.add(name).add(values);
  }
  for (const auto& [name, value] : image.metadata)
    if (name != kCacheFingerprint && !value.empty())
      print.add(name).add(value);  // files lack empty values
  return print.hex();
}

/// Returns the ground truth in an entry's bytes. Throws if they are damaged.
GroundTruth decode(const std::filesystem::path& file, const std::string& bytes,
                   const SceneData& scene) {
  GroundTruth truth;
  truth.image = decode_image(file, bytes);
  truth.file = file;
  if (const auto found = truth.image.metadata.find(kCacheFingerprint);
      found == truth.image.metadata.end() || found->second != fingerprint_of(truth.image))
    throw Error(ExitCode::bad_input, "{}: damaged: its fingerprint differs", file.string());
  for (const Show show : views_of(scene.medium.has_value()))
    extract_layer(truth.image, std::string(name_of(show)), file.string());  // throws
  truth.samples = static_cast<std::uint32_t>(std::stoul(truth.image.metadata.at("spp_traced")));
  truth.noise = std::stod(truth.image.metadata.at("noise_reached"));
  return truth;
}

}  // namespace

std::string scene_fingerprint(const SceneData& scene) {
  Fingerprint print;
  print.add(scene.vertices).add(scene.triangles).add(scene.materials);
  for (const Texture& texture : scene.textures) {
    print.add(texture.width)
        .add(texture.height)
        .add(texture.wrap_u)
        .add(texture.wrap_v)
        .add(texture.rgba);
  }
  if (scene.sky) add_sky(print, *scene.sky);
  if (scene.medium) print.add(*scene.medium);
  return print.hex();
}

namespace {

constexpr std::uintmax_t kMaxBytes = ImageLimits().file_bytes;

/// Returns the cached ground truth if its entry is sound.
std::optional<GroundTruth> read_cached(const CacheFolder& cache, const std::string& name,
                                       const SceneData& scene) {
  const auto bytes = cache.read(name, kMaxBytes);
  if (!bytes) return std::nullopt;
  try {
    return decode(cache.path() / name, *bytes, scene);
  } catch (const std::exception& error) {
    spdlog::warn("{}; traced again", error.what());
    return std::nullopt;
  }
}

/// Warns of a problem of the cache. Returns true if there is none.
bool can_be_cached(const std::string& problem) {
  if (!problem.empty()) spdlog::warn("{}: the ground truth is not cached", problem);
  return problem.empty();
}

}  // namespace

GroundTruth cached_ground_truth(const std::filesystem::path& folder, const SceneData& scene,
                                const SceneCamera& camera, int width, int height,
                                const pathtracer::PathTracerOptions& options,
                                const pathtracer::TraceProgress& progress, Ranks& ranks) {
  const ClpvView view = camera_view(camera, width, height);
  const CacheFolder cache(folder);
  const std::string name = fmt::format("{}-{}.exr", view_file_name(scene.name, camera.name),
                                       key(scene, camera, view, options));
  std::optional<GroundTruth> kept;
  bool cached = false;
  const std::string found = ranks.from_root([&] {
    kept = read_cached(cache, name, scene);
    if (!kept) cached = can_be_cached(cache.problem());
    return kept ? "there" : "";
  });
  if (!found.empty() && !kept) kept = read_cached(cache, name, scene);
  if (!found.empty() && !kept)
    throw Error(ExitCode::run_time, "{}: root has it, but this rank cannot read it",
                (folder / name).string());
  if (kept) {
    kept->exposure = scene.exposure;
    return *std::move(kept);
  }
  const pathtracer::TracedImage traced =
      pathtracer::trace_paths(scene, scene.lights_for(camera), view, options, progress, ranks);
  GroundTruth truth{all_views(traced), folder / name, true,
                    traced.samples,    traced.noise,  scene.exposure};
  describe(truth.image, scene, camera, traced, options);
  if (cached) {  // at rank 0
    truth.image.metadata[kCacheFingerprint] = fingerprint_of(truth.image);
    const auto bytes = exr_bytes(truth.image);
    can_be_cached(cache.write(name, std::as_bytes(std::span(bytes))));
  }
  return truth;
}

}  // namespace clpv
