// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bake/ktx2.hpp"
#include "cli/bake_parts.hpp"
#include "clpv/version.hpp"
#include "scene/bounds.hpp"
#include "support/array_files.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
#include "support/text.hpp"

namespace clpv::bake_command {

/// '-' for what is unknown.
std::string decimal(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

/// Says why errors are unknown.
void say_unknown(const char* where, const CheckPoints& points) {
  if (points.points.empty()) {
    log_warning("no points {} within the bounds that are not inside walls: errors there are '-'",
                where);
  } else if (std::ranges::all_of(points.truth,
                                 [](const glm::dvec3& e) { return e == glm::dvec3(0); })) {
    log_warning("the truth {} is dark: relative errors there are '-'", where);
  }
}

std::string given_row(const std::string& name, const std::string& numbers, const std::string& bytes,
                      double mean, double nrmse) {
  return fmt::format("{:<18}{:>8}{:>7}{:>12.5g}{:>9}\n", name, numbers, bytes, mean,
                     decimal(100 * nrmse, 1));
}

Check::Check(const Options& options, pathtracer::PointTracer& tracer, const ProbeGrid& grid,
             std::vector<SurfacePoint> given)
    : given_(!given.empty()) {
  if (given_) {
    surfaces_ = given_points(tracer, std::move(given), options.direct, noise_[0]);
  } else {
    surfaces_ = surface_points(tracer, grid, options.check, options.direct, noise_[0]);
    air_ = air_points(tracer, grid, options.check, options.direct, noise_[1]);
  }
}

std::string Check::header() const {
  if (!given_)
    return fmt::format("{:<18}{:>8}{:>7}{:>10}{:>9}{:>9}{:>9}{:>11}\n", "format", "numbers",
                       "bytes", "surface %", "energy", "air %", "energy", "negative %");
  glm::dvec3 sum(0);
  for (const glm::dvec3& light : surfaces_.truth) sum += light;
  return fmt::format("{:<18}{:>8}{:>7}{:>12}{:>9}\n", "format", "numbers", "bytes", "mean W/m^2",
                     "error %") +
         given_row("truth", "", "",
                   (sum.x + sum.y + sum.z) / 3 / static_cast<double>(surfaces_.truth.size()), 0);
}

std::string Check::row(const ProbeFormat& format, const BakedProbes& baked) const {
  const ProbeError on = error_of(format, baked, surfaces_, kSurfaceLift);
  if (given_)
    return given_row(format.name, std::to_string(format.size), std::to_string(6 * format.size),
                     on.mean, on.nrmse);
  const ProbeError off = error_of(format, baked, air_, 0);
  return fmt::format("{:<18}{:>8}{:>7}{:>10}{:>9}{:>9}{:>9}{:>11.1f}\n", format.name, format.size,
                     6 * format.size, decimal(100 * on.nrmse, 1), decimal(on.energy, 3),
                     decimal(100 * off.nrmse, 1), decimal(off.energy, 3), 100 * off.negative);
}

nlohmann::json Check::error(const ProbeFormat& format, const BakedProbes& baked) const {
  const auto described = [&](const CheckPoints& points, std::size_t normals, double lift,
                             double noise) {
    const ProbeError error = error_of(format, baked, points, lift);
    return nlohmann::json{{"points", points.points.size() / normals},
                          {"nrmse", number(error.nrmse)},
                          {"energy", number(error.energy)},
                          {"negative", error.negative},
                          {"truth_noise", number(noise)}};
  };
  return {{"surfaces", described(surfaces_, 1, kSurfaceLift, noise_[0])},
          {"air", described(air_, 6, 0, noise_[1])}};
}

void Check::report(const ProbeGrid& grid) const {
  const glm::dvec3 spacing = grid.spacing();
  log_info("{} x {} x {} probes, {:.3g} x {:.3g} x {:.3g} m apart", grid.count.x, grid.count.y,
           grid.count.z, spacing.x, spacing.y, spacing.z);
  if (given_) {
    log_info("{} points, noise {}", surfaces_.points.size(), decimal(noise_[0], 4));
    const auto far = std::ranges::count_if(
        surfaces_.points, [&](const SurfacePoint& point) { return grid.is_far(point.position); });
    if (far > 0)
      log_warning(
          "{} of {} points lie more than half a spacing outside the probes, which have only the "
          "light of their border there; --bounds decides",
          far, surfaces_.points.size());
    return;
  }
  log_info("{} points of surfaces and {} in the air, noise {} and {}", surfaces_.points.size(),
           air_.points.size() / 6, decimal(noise_[0], 4), decimal(noise_[1], 4));
  say_unknown("on surfaces", surfaces_);
  say_unknown("in the air", air_);
}

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

constexpr double kMaxProbes = 1 << 22;
constexpr double kMaxBytes = 1 << 30;  // all coefficients, as 32-bit floats
constexpr int kDefaultProbes = 16;     // along the longest edge
constexpr double kInset = 0.125;       // inset of the default bounds, in spacings: off walls

/// Throws Error(usage).
template <typename Number, std::size_t Count>
std::array<Number, Count> numbers_of(const char* option, const std::string& text,
                                     const char* allowed) {
  if (const auto numbers = parse_numbers<Number, Count>(text)) return *numbers;
  throw Error(ExitCode::usage, "{}: found '{}', allowed: {}", option, text, allowed);
}

/// Sets the positions of the outermost probes.
void set_bounds(const Options& options, const SceneData& scene, ProbeGrid& grid) {
  grid.lower = glm::dvec3(scene.lower), grid.upper = glm::dvec3(scene.upper);
  if (!options.bounds.empty()) {
    const auto n = numbers_of<double, 6>(
        "--bounds", options.bounds, "six numbers between commas, the lower and the upper corner");
    grid.lower = {n[0], n[1], n[2]}, grid.upper = {n[3], n[4], n[5]};
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (grid.lower[axis] < grid.upper[axis] &&
        std::max(std::abs(grid.lower[axis]), std::abs(grid.upper[axis])) <= bounds::kCoordinate)
      continue;
    throw Error(ExitCode::usage,
                "{}: found {} to {} along {}, allowed: a lower and a larger number, within +-{} m",
                options.bounds.empty() ? "--bounds, by default the scene's box" : "--bounds",
                grid.lower[axis], grid.upper[axis], "xyz"[axis], bounds::kCoordinate);
  }
}

ProbeGrid grid_of(const Options& options, const SceneData& scene, std::size_t numbers) {
  ProbeGrid grid;
  set_bounds(options, scene, grid);
  const glm::dvec3 edges = grid.upper - grid.lower;
  std::array<double, 3> count{};
  if (!options.probes.empty()) {
    const auto n = numbers_of<int, 3>("--probes", options.probes, "three numbers between commas");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (n[axis] < 1)
        throw Error(ExitCode::usage, "--probes: found {}, allowed: 1 or more along each axis",
                    n[axis]);
      count[axis] = n[axis];
    }
  } else {
    const double longest = std::max({edges.x, edges.y, edges.z}),
                 spacing = options.spacing > 0 ? options.spacing : longest / (kDefaultProbes - 1);
    for (int axis = 0; axis < 3; ++axis)
      count[static_cast<std::size_t>(axis)] =
          spacing > 0 ? std::max(2.0, std::round(edges[axis] / spacing) + 1) : 2.0;
  }
  const double all = count[0] * count[1] * count[2],
               bytes = all * 12 * static_cast<double>(numbers);
  if (!(all <= kMaxProbes && bytes <= kMaxBytes))
    throw Error(ExitCode::usage,
                "probes: found {:.0f} x {:.0f} x {:.0f}, {:.4g} MiB of coefficients; allowed: at "
                "most {:.0f} probes and {:.0f} MiB",
                count[0], count[1], count[2], bytes / (1 << 20), kMaxProbes, kMaxBytes / (1 << 20));
  for (std::size_t axis = 0; axis < 3; ++axis)
    grid.count[static_cast<int>(axis)] = static_cast<int>(count[axis]);
  if (options.bounds.empty()) {
    const glm::dvec3 several(glm::greaterThan(grid.count, glm::ivec3(1))),
        inset = kInset * several * grid.spacing();
    grid.lower += inset, grid.upper -= inset;
  }
  return grid;
}

}  // namespace clpv::bake_command
