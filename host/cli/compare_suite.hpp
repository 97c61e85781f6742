// SPDX-License-Identifier: MIT
// Comparison of a folder of images, by any renderer, with cached ground truths.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace clpv {

/// Compares each folder/SCENE-CAMERA.exr with the view `indirect` of the ground truth
/// truths/SCENE-CAMERA-HASH.exr of the same size that has its view_hash, or, where the image has
/// none, that suite.json lists (in `truths` or above). Returns the errors of each view, sorted by
/// name, and the mean NRMSE. Throws Error(bad_input) for a folder without an image, and for an
/// image with no ground truth or several.
nlohmann::json compare_suite(const std::filesystem::path& folder,
                             const std::filesystem::path& truths, float exposure);

}  // namespace clpv
