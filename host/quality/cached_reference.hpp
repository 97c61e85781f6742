// SPDX-License-Identifier: MIT
// Path-traced references kept on disk: traced once, read ever after.
#pragma once

#include <filesystem>

#include "image/image.hpp"
#include "pathtracer/path_tracer.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

/// The truth of one view: an image with one layer a view of a frame ("indirect", ...; traced_view).
struct Reference {
  Image image;
  std::filesystem::path file;  ///< where it is kept
  bool traced = false;         ///< just now; false: read
  std::uint32_t samples = 0;
  double noise = 0;  ///< TracedImage::noise
};

/// The reference of `camera`, from `folder` if it is there, else traced and put there. Its name tells everything the
/// result depends on: the scene's content, camera, size, options and this program's version, but not where files lie.
/// A file that is there but cannot be read is traced anew, with a warning.
/// By all `ranks`, each of which has it then; rank 0 looks whether it is there, and writes it.
/// Throws like trace_paths, and Error(run_time) where the folder cannot be written (before tracing).
Reference cached_reference(const std::filesystem::path& folder, const Scene& scene, const Camera& camera,
                           int width, int height, const PathTracerOptions& options,
                           const TraceProgress& progress = {}, Ranks& ranks = single_rank());

/// Of everything in the scene that light can tell: geometry, materials, textures.
std::string scene_fingerprint(const Scene& scene);

}  // namespace clpv::reference
