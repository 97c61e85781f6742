// SPDX-License-Identifier: MIT
#include "cli/compare_suite.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/image_layer.hpp"
#include "image/compare.hpp"
#include "quality/ground_truth.hpp"
#include "support/error.hpp"
#include "support/json_schema.hpp"

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

std::string hash_in(const Image& image) {
  const auto found = image.metadata.find(kViewHash);
  return found == image.metadata.end() ? std::string() : found->second;
}

/// File names of the truths in suite.json, in the folder or the one above, by view; empty without
/// that file.
std::map<std::string, std::string> listed_in(const fs::path& truths) {
  std::map<std::string, std::string> names;
  for (const fs::path& file : {truths / "suite.json", truths / ".." / "suite.json"}) {
    if (!fs::exists(file)) continue;
    const nlohmann::json suite = read_json(file);
    check_rules(suite,
                std::vector<Rule>{rule::object(""), rule::list("/views", 1, 1 << 20).must(),
                                  rule::object("/views/*"), rule::text("/views/*/name").must(),
                                  rule::text("/views/*/truth").must()},
                file.string());
    for (const nlohmann::json& view : suite["views"])
      names[view["name"]] = fs::path(view["truth"].get<std::string>()).filename().string();
    break;
  }
  return names;
}

/// Ground truths of an image: of its size and name, and with its view_hash, or where it has none,
/// the one that suite.json lists. Throws Error(bad_input) unless there is one.
std::pair<fs::path, Image> truth_of(const fs::path& file, const Image& image,
                                    const std::vector<fs::path>& candidates,
                                    const std::map<std::string, std::string>& listed,
                                    const fs::path& truths) {
  const std::string stem = file.stem().string(), hash = hash_in(image);
  const auto in_list = listed.find(stem);
  if (hash.empty() && in_list == listed.end()) {
    throw Error(ExitCode::bad_input,
                "{}: found no metadata clpv:{}, and no view {} in a suite.json of {}; allowed: one "
                "of the two",
                file.string(), kViewHash, stem, truths.string());
  }
  std::vector<std::pair<fs::path, Image>> found;
  for (const fs::path& truth : candidates) {
    if (!is_truth_of(truth.stem().string(), stem)) continue;
    if (hash.empty() && truth.filename() != in_list->second) continue;
    Image read = read_image_layer(truth, "indirect");
    if (read.width == image.width && read.height == image.height &&
        (hash.empty() || hash_in(read) == hash))
      found.emplace_back(truth, std::move(read));
  }
  if (found.size() == 1) return std::move(found[0]);
  throw Error(
      ExitCode::bad_input, "{}: found {} ground truths {} of {}x{} pixels{} in {}; allowed: one",
      file.string(), found.size(), hash.empty() ? in_list->second : stem + "-HASH.exr", image.width,
      image.height, hash.empty() ? "" : " and of its scene, lights and camera", truths.string());
}

}  // namespace

nlohmann::json compare_suite(const fs::path& folder, const fs::path& truths, float exposure) {
  const std::vector<fs::path> files = images_in(folder), candidates = images_in(truths);
  if (files.empty())
    throw Error(ExitCode::bad_input, "{}: no image; allowed: SCENE-CAMERA.exr", folder.string());
  const std::map<std::string, std::string> listed = listed_in(truths);
  nlohmann::json views = nlohmann::json::array();
  double sum = 0;
  std::size_t defined = 0;
  for (const fs::path& file : files) {
    const Image image = read_image_layer(file, "");
    const auto [path, truth] = truth_of(file, image, candidates, listed, truths);
    const Comparison errors = compare(image, file.string(), truth, path.string(), exposure);
    require_valid_pixels(errors, file.string(), path.string());
    nlohmann::json view = to_json(errors);
    view.update({{"view", file.stem().string()}, {"ground_truth", path.filename().string()}});
    views.push_back(std::move(view));
    sum += errors.nrmse_valid.value_or(0);
    defined += errors.nrmse_valid.has_value();
  }
  nlohmann::json mean;  // null if the error of a view is undefined: means of other views differ
  if (defined == files.size()) mean = sum / static_cast<double>(defined);
  return {{"views", views}, {"mean_nrmse", mean}, {"undefined", files.size() - defined}};
}

}  // namespace clpv
