// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/bake_parts.hpp"
#include "scene/bounds.hpp"
#include "support/error.hpp"
#include "support/text.hpp"

namespace clpv::bake_command {
namespace {

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

}  // namespace

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
