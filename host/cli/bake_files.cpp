// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>

#include "bake/ktx2.hpp"
#include "cli/bake_parts.hpp"
#include "clpv/version.hpp"
#include "support/array_files.hpp"
#include "support/interrupt.hpp"
#include "support/output_file.hpp"
#include "support/text.hpp"

namespace clpv::bake_command {
namespace {

nlohmann::json array_of(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

/// The description beside the file.
nlohmann::json described(const Options& options, const SceneData& scene, const ProbeFormat& format,
                         const BakedProbes& baked, const GridLight& light, double intensity,
                         const nlohmann::json& error) {
  const ProbeGrid& grid = baked.grid;
  const glm::dvec3 middle = (grid.lower + grid.upper) / 2.0, edges = grid.upper - grid.lower,
                   spacing = grid.spacing();
  const auto invalid = std::ranges::count(baked.valid, 0);
  nlohmann::json json = {{"schema", 1},
                         {"command", "bake"},
                         {"version", version()},
                         {"scene", printable(options.request.scene)},
                         {"scene_hash", scene_fingerprint(scene)},
                         {"time", options.time},
                         {"format", format.name},
                         {"numbers", format.size},
                         {"meaning", format.meaning},
                         {"from", name_of(options.from)},
                         {"bounces", options.tracing.bounces},
                         {"direct", options.direct},
                         {"probes", {grid.count.x, grid.count.y, grid.count.z}},
                         {"bounds", {array_of(grid.first()), array_of(grid.last())}},
                         {"spacing", array_of(spacing)},
                         {"invalid", invalid},
                         {"dilated", baked.filled && invalid > 0},
                         {"negative", baked.negative},
                         {"intensity", intensity}};
  if (!error.is_null()) json["error"] = error;
  if (options.from == BakeSource::pathtrace) {
    json["spp"] = light.samples;
    json["noise"] = std::isnan(light.noise) ? nlohmann::json() : nlohmann::json(light.noise);
    json["seed"] = options.tracing.values.seed;
  }
  if (suffix_of(options) != ".ktx2") return json;
  if (format.size == 6) {
    json["bevy"] = {{"translation", array_of(middle)},
                    {"scale", array_of(glm::dvec3(grid.count) * spacing)}};
  } else {
    json["three"] = {{"position", array_of(middle)},
                     {"width", edges.x},
                     {"height", edges.y},
                     {"depth", edges.z}};
  }
  return json;
}

std::string npz_of(const ProbeFormat& format, const BakedProbes& baked) {
  const ProbeGrid& grid = baked.grid;
  const auto x = static_cast<std::size_t>(grid.count.x), y = static_cast<std::size_t>(grid.count.y),
             z = static_cast<std::size_t>(grid.count.z);
  std::vector<float> positions, coefficients, valid(baked.valid.begin(), baked.valid.end());
  const auto add = [](std::vector<float>& to, const glm::vec3& v) {
    to.insert(to.end(), {v.x, v.y, v.z});
  };
  for (const glm::dvec3& p : positions_of(grid)) add(positions, glm::vec3(p));
  for (const glm::vec3& c : baked.coefficients) add(coefficients, c);
  std::vector<float> corners, spacing;
  add(corners, glm::vec3(grid.first())), add(corners, glm::vec3(grid.last()));
  add(spacing, glm::vec3(grid.spacing()));
  using Shape = std::vector<std::size_t>;
  return npz_bytes({{"position", npy_bytes(positions, Shape{z, y, x, 3})},
                    {"coefficients", npy_bytes(coefficients, Shape{z, y, x, format.size, 3})},
                    {"validity", npy_bytes(valid, Shape{z, y, x})},
                    {"bounds", npy_bytes(corners, Shape{2, 3})},
                    {"spacing", npy_bytes(spacing, Shape{3})},
                    {"format", npy_bytes(format.name)},
                    {"meaning", npy_bytes(format.meaning)}});
}

}  // namespace

std::string suffix_of(const Options& options) {
  return std::filesystem::path(options.output).extension().string();
}

std::string description_file(const Options& options) {
  return options.output.empty() ? "" : options.output + ".json";
}

void write_probes(const Options& options, const SceneData& scene, const ProbeFormat& format,
                  const BakedProbes& baked, const GridLight& light, const nlohmann::json& error) {
  const bool ktx2 = suffix_of(options) == ".ktx2";
  const double intensity = ktx2 ? intensity_of(baked) : 1;
  const std::string bytes =
      ktx2 ? ktx2_bytes(texture_of(format, baked, intensity), "clpv " + version())
           : npz_of(format, baked);
  const std::string json =
      described(options, scene, format, baked, light, intensity, error).dump(2) + "\n";
  OutputFile data(options.output), text(description_file(options), OutputFile::Kind::derived);
  data.write(std::as_bytes(std::span(bytes)));
  text.write(std::as_bytes(std::span(json)));
  stop_if_interrupted();
  data.commit();
  text.commit();
}

}  // namespace clpv::bake_command
