// SPDX-License-Identifier: MIT
#include "quality/ground_truth.hpp"

#include <fmt/format.h>

#include <cctype>

#include "clpv/version.hpp"
#include "image/image_io.hpp"
#include "pathtracer/path_tracer.hpp"
#include "pipeline/raster/view.hpp"
#include "scene/emission.hpp"
#include "support/cache_folder.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/log.hpp"
#include "support/named_enum.hpp"
#include "support/text.hpp"

namespace clpv {
namespace detail {
/// Hash of all sources that make a ground truth (cmake/ground_truth_sources.cmake).
const char* ground_truth_sources();
}  // namespace detail
namespace {

std::string key(const SceneData& scene, const SceneCamera& camera, const ClpvView& view,
                const pathtracer::PathTracerOptions& options) {
  Fingerprint print;
  print.add(std::string_view(detail::ground_truth_sources())).add(scene_fingerprint(scene));
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
  image.metadata[kViewHash] = view_hash(scene, camera, image.width, image.height);
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
  add_pixels(print, image);
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

constexpr std::uintmax_t kMaxBytes = ImageLimits().file_bytes;

/// Returns the bytes of a ground truth's entry, or "" if it is missing or damaged.
std::string read_cached(const CacheFolder& cache, const std::string& name, const SceneData& scene) {
  const auto bytes = cache.read(name, kMaxBytes);
  if (!bytes) return {};
  try {
    decode(cache.path() / name, *bytes, scene);
    return *bytes;
  } catch (const std::exception& error) {
    log_warning("{}; traced again", error.what());
    return {};
  }
}

/// Warns of a problem of the cache. Returns true if there is none.
bool can_be_cached(const std::string& problem) {
  if (!problem.empty()) log_warning("{}: the ground truth is not cached", problem);
  return problem.empty();
}

}  // namespace

std::string view_hash(const SceneData& scene, const SceneCamera& camera, int width, int height) {
  Fingerprint print;
  print.add(scene_fingerprint(scene)).add(std::vector{camera_view(camera, width, height)});
  for (const SceneLight& light : scene.lights_for(camera)) print.add(std::vector{light.data});
  return print.hex();
}

GroundTruth cached_ground_truth(const std::filesystem::path& folder, const SceneData& scene,
                                const SceneCamera& camera, int width, int height,
                                const pathtracer::PathTracerOptions& options,
                                const pathtracer::TraceProgress& progress, Ranks& ranks) {
  const ClpvView view = camera_view(camera, width, height);
  const CacheFolder cache(folder);
  const std::string name = fmt::format("{}-{}.exr", view_file_name(scene.name, camera.name),
                                       key(scene, camera, view, options));
  bool cached = false;
  const std::string found = ranks.from_root([&] {
    std::string bytes = read_cached(cache, name, scene);
    if (bytes.empty()) cached = can_be_cached(cache.problem());
    return bytes;
  });
  if (!found.empty()) {
    GroundTruth kept = decode(folder / name, found, scene);
    kept.exposure = scene.exposure.value_or(0);
    return kept;
  }
  const pathtracer::TracedImage traced =
      pathtracer::trace_paths(scene, scene.lights_for(camera), view, options, progress, ranks);
  GroundTruth truth{all_views(traced), folder / name, true,
                    traced.samples,    traced.noise,  scene.exposure.value_or(0)};
  describe(truth.image, scene, camera, traced, options);
  if (cached) {  // at rank 0
    truth.image.metadata[kCacheFingerprint] = fingerprint_of(truth.image);
    const auto bytes = exr_bytes(truth.image);
    can_be_cached(cache.write(name, std::as_bytes(std::span(bytes))));
  }
  return truth;
}

}  // namespace clpv
