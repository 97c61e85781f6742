// SPDX-License-Identifier: MIT
// Path-traced ground truths, cached on disk.
#pragma once

#include <filesystem>

#include "image/image.hpp"
#include "pathtracer/path_tracer.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Ground truth of one camera: an image with one layer per view of a frame ("indirect", ...;
/// pathtracer::traced_view).
struct GroundTruth {
  Image image;
  std::filesystem::path file;  ///< cache file
  bool traced = false;         ///< true: traced by this call; false: read from the cache
  std::uint32_t samples = 0;
  double noise = 0;    ///< pathtracer::TracedImage::noise
  float exposure = 0;  ///< the scene's [EV]
};

/// Metadata of ground truths and of rendered views of indirect light: view_hash().
inline constexpr const char* kViewHash = "view_hash";

/// Hash of what a view of this size shows: content of the scene, lights and camera.
std::string view_hash(const SceneData& scene, const SceneCamera& camera, int width, int height);

/// Returns the ground truth of `camera` from the cache in `folder`; traces and stores it if it is
/// missing. The file name contains a key over scene content, camera, size, options and the tracer's
/// sources, but no file paths. A damaged file is traced again, with a warning; one that CacheFolder
/// does not trust is ignored. Collective over all `ranks`; each rank receives the result. Only rank
/// 0 reads and writes the cache, whose folder other hosts need not share. A folder that cannot be
/// written is a warning before tracing, and a failure to write one after it. Throws like
/// pathtracer::trace_paths.
GroundTruth cached_ground_truth(const std::filesystem::path& folder, const SceneData& scene,
                                const SceneCamera& camera, int width, int height,
                                const pathtracer::PathTracerOptions& options,
                                const pathtracer::TraceProgress& progress = {},
                                Ranks& ranks = single_rank());

}  // namespace clpv
