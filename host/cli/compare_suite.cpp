// SPDX-License-Identifier: MIT
#include "cli/compare_suite.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/image_layer.hpp"
#include "image/compare.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

/// EXR files of a folder, sorted by name.
std::vector<fs::path> images_in(const fs::path& folder) {
  std::error_code failure;
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failure))
    if (entry.path().extension() == ".exr") files.push_back(entry.path());
  if (failure) throw Error(ExitCode::bad_input, "{}: {}", folder.string(), failure.message());
  std::ranges::sort(files);
  return files;
}

/// True for "NAME-HASH" with 16 hexadecimal digits.
bool is_truth_of(const std::string& stem, const std::string& name) {
  constexpr std::size_t kDigits = 16;
  return stem.size() == name.size() + 1 + kDigits && stem.starts_with(name + "-") &&
         stem.find_first_not_of("0123456789abcdef", name.size() + 1) == std::string::npos;
}

}  // namespace

nlohmann::json compare_suite(const fs::path& folder, const fs::path& truths, float exposure) {
  const std::vector<fs::path> files = images_in(folder), candidates = images_in(truths);
  if (files.empty())
    throw Error(ExitCode::bad_input, "{}: no image; allowed: SCENE-CAMERA.exr", folder.string());
  nlohmann::json views = nlohmann::json::array();
  double sum = 0;
  for (const fs::path& file : files) {
    const Image image = read_image_layer(file, "");
    std::vector<std::pair<fs::path, Image>> found;
    for (const fs::path& truth : candidates) {
      if (!is_truth_of(truth.stem().string(), file.stem().string())) continue;
      Image read = read_image_layer(truth, "indirect");
      if (read.width == image.width && read.height == image.height)
        found.emplace_back(truth, std::move(read));
    }
    if (found.size() != 1) {
      throw Error(ExitCode::bad_input,
                  "{}: found {} ground truths {}-HASH.exr of {}x{} pixels in {}; allowed: one",
                  file.string(), found.size(), file.stem().string(), image.width, image.height,
                  truths.string());
    }
    const auto& [path, truth] = found[0];
    const Comparison errors = compare(image, file.string(), truth, path.string(), exposure);
    nlohmann::json view = to_json(errors);
    view.update({{"view", file.stem().string()}, {"ground_truth", path.filename().string()}});
    views.push_back(std::move(view));
    sum += errors.nrmse_valid.value_or(0);
  }
  return {{"views", views}, {"mean_nrmse", sum / static_cast<double>(files.size())}};
}

}  // namespace clpv
