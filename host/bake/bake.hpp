// SPDX-License-Identifier: MIT
// Bakes probes: light of a source, in a format, with probes inside walls filled from others
// (docs/bake.md).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "basis/matrix.hpp"
#include "device/session.hpp"
#include "options/render_options.hpp"
#include "pathtracer/point_tracer.hpp"
#include "scene/input.hpp"
#include "scene/scene.hpp"
#include "support/cache_folder.hpp"

namespace clpv::bake {

// Formats of light probes: a few numbers per channel for the light that arrives at a point, and the
// irradiance that an engine makes of them (docs/bake.md, 'Formats'; probe_formats.cpp).

using pathtracer::Moments;

/// A format. Coefficients are red, green, blue of each number.
struct ProbeFormat {
  std::string name;
  std::size_t size = 0;  ///< numbers per channel
  std::string meaning;   ///< meaning of the numbers, with their unit
  Moments moments;       ///< integrals of arriving radiance that encode() takes
  /// Null: the integrals are the coefficients.
  std::function<std::vector<glm::dvec3>(std::span<const glm::dvec3> integrals)> encode = {};
  /// Irradiance [W/m^2] of a surface with a unit normal, negative where the format undershoots.
  std::function<glm::dvec3(std::span<const glm::dvec3> c, const glm::dvec3& normal)> irradiance;
  std::vector<glm::dvec3> creases = {};  ///< normals of planes where `moments` jump

  std::vector<glm::dvec3> encoded(std::span<const glm::dvec3> integrals) const {
    return encode ? encode(integrals) : std::vector<glm::dvec3>(integrals.begin(), integrals.end());
  }
};

/// Names of all formats, in ascending size.
std::vector<std::string> probe_format_names();
/// Throws Error(usage) for an unknown name; the message lists all.
ProbeFormat probe_format(const std::string& name);

/// 128 unit normals in equal parts of the octants, and their solid angles [sr].
struct NormalSet {
  std::vector<glm::dvec3> normals;
  std::vector<double> weights;
};
const NormalSet& probe_normals();

/// Share of probe_normals() whose irradiance has a negative luminance.
double negative_share(const ProbeFormat& format, std::span<const glm::dvec3> c);

/// Count x 9: integrals of the nine harmonics in the order of SphericalHarmonics.
Matrix of_harmonics(const ProbeFormat& format);

// Where probes have their light from: swept volumes, or path tracing.

// A regular grid of probes, x fastest, and look-ups between them.

/// `lower` and `upper` are the positions of the outermost probes [m]; a single probe along an axis
/// is in the middle.
struct ProbeGrid {
  glm::ivec3 count{2};
  glm::dvec3 lower{0}, upper{1};

  std::size_t size() const {
    return static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y) *
           static_cast<std::size_t>(count.z);
  }
  /// Distance of neighbours [m]; of a single probe: the edge.
  glm::dvec3 spacing() const { return (upper - lower) / glm::dvec3(glm::max(count - 1, 1)); }
  std::size_t index(const glm::ivec3& at) const {
    return (static_cast<std::size_t>(at.z) * static_cast<std::size_t>(count.y) +
            static_cast<std::size_t>(at.y)) *
               static_cast<std::size_t>(count.x) +
           static_cast<std::size_t>(at.x);
  }
  glm::ivec3 at(std::size_t index) const {
    const auto x = static_cast<std::size_t>(count.x), y = static_cast<std::size_t>(count.y);
    return {static_cast<int>(index % x), static_cast<int>(index / x % y),
            static_cast<int>(index / (x * y))};
  }
  glm::dvec3 position(std::size_t index) const {
    const glm::ivec3 place = at(index);
    glm::dvec3 p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = count[axis] == 1 ? (lower[axis] + upper[axis]) / 2
                                 : lower[axis] + place[axis] * spacing()[axis];
    return p;
  }
  glm::dvec3 first() const { return position(0); }
  glm::dvec3 last() const { return position(size() - 1); }
  /// Returns true if a position is more than half a spacing outside the bounds.
  bool is_far(const glm::dvec3& position) const {
    const glm::dvec3 outside = glm::max(lower - position, position - upper);
    return glm::any(glm::greaterThan(outside, spacing() / 2.0));
  }
};

/// Positions of all probes.
inline std::vector<glm::dvec3> positions_of(const ProbeGrid& grid) {
  std::vector<glm::dvec3> positions;
  for (std::size_t i = 0; i < grid.size(); ++i) positions.push_back(grid.position(i));
  return positions;
}

/// Trilinear interpolation of `n` numbers per probe at a position [m], which is clamped to the
/// grid.
inline std::vector<glm::dvec3> interpolated(const ProbeGrid& grid,
                                            std::span<const glm::vec3> coefficients, std::size_t n,
                                            const glm::dvec3& position) {
  const glm::dvec3 t = (position - grid.lower) / grid.spacing();
  glm::ivec3 low;
  glm::dvec3 part;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = std::clamp(t[axis], 0.0, grid.count[axis] - 1.0);
    low[axis] = std::min(static_cast<int>(at), std::max(grid.count[axis] - 2, 0));
    part[axis] = at - low[axis];
  }
  std::vector<glm::dvec3> sum(n, glm::dvec3(0));
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 off(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::dvec3 shares = glm::mix(1.0 - part, part, glm::dvec3(off));
    const double weight = shares.x * shares.y * shares.z;
    if (weight == 0) continue;
    const std::size_t first = grid.index(low + off) * n;
    for (std::size_t i = 0; i < n; ++i) sum[i] += weight * glm::dvec3(coefficients[first + i]);
  }
  return sum;
}

/// Integrals of the light at some probes of a grid.
struct BlockLight {
  std::vector<glm::vec3> integrals;  ///< [probe of the block][integral]
  float noise = 0;                   ///< TracedProbes::noise; 0 without paths
  std::uint32_t samples = 0;         ///< paths per probe; 0 without paths
};

/// Blocks of probes, in an order that does not depend on what was computed before.
class ProbeSource {
 public:
  virtual ~ProbeSource() = default;
  const std::vector<std::vector<std::size_t>>& blocks() const { return blocks_; }
  virtual BlockLight light(std::size_t block) = 0;

 protected:
  std::vector<std::vector<std::size_t>> blocks_;
};

/// Light of the volumes of frames whose finest cascades cover the grid. `formats`: whose integrals
/// follow each other. `options`: of the frames; near field off. Arguments must outlive the source.
/// Probes have the light half a cell off surfaces: cells that walls cut have too little.
/// Throws Error(usage) without a sweep, and for a grid that takes more than kMaxBakeFrames.
std::unique_ptr<ProbeSource> swept_light(Session& session, const SceneData& scene,
                                         const SceneCamera& camera, const RenderOptions& options,
                                         const ProbeGrid& grid,
                                         const std::vector<ProbeFormat>& formats,
                                         pathtracer::PointTracer& tracer);
inline constexpr std::size_t kMaxBakeFrames = 4096;

/// Path-traced light. All blocks have the noise relative to the light of the whole grid.
std::unique_ptr<ProbeSource> traced_light(pathtracer::PointTracer& tracer, const ProbeGrid& grid,
                                          const std::vector<ProbeFormat>& formats,
                                          bool fixed_samples);

/// The integrals of several formats, one after the other.
Moments joined(const std::vector<ProbeFormat>& formats);

/// Integrals of all probes of a grid: [probe][integral].
struct GridLight {
  std::size_t count = 0;  ///< integrals per probe
  std::vector<glm::vec3> integrals;
  std::uint32_t samples = 0;  ///< maximum number of paths per probe
  double noise = 0;           ///< root mean square over all blocks
};

/// Blocks of an interrupted bake, in a cache. The key, of letters and digits, has all inputs.
/// Blocks of other bakes stay for 30 days, at most 1 GiB of them.
class BlockCache {
 public:
  /// No folder: nothing is kept.
  BlockCache(const std::optional<std::filesystem::path>& folder, std::string key);
  std::optional<BlockLight> read(std::size_t block, std::size_t numbers) const;
  /// Warns if the block cannot be kept; nothing is kept from then on.
  void write(std::size_t block, const BlockLight& light);
  bool keeps() const { return folder_.has_value(); }
  /// Removes the blocks of this bake below `count`.
  void clear(std::size_t count);

 private:
  std::string name_of(std::size_t block) const;

  std::optional<CacheFolder> folder_;
  std::string key_;
};

/// Light of all blocks. Throws Error(run_time) for light that is not finite. `done` receives the
/// number of blocks that are finished.
GridLight light_of(ProbeSource& source, const ProbeGrid& grid, std::size_t count, BlockCache& cache,
                   const std::function<void(std::size_t)>& done);

/// Probes in a format.
struct BakedProbes {
  ProbeGrid grid;
  std::vector<glm::vec3> coefficients;  ///< [probe][number], red, green, blue
  std::vector<std::uint8_t> valid;      ///< 1, or 0 inside walls
  bool filled = false;                  ///< invalid probes have the light of valid ones, if any
  double negative = 0;                  ///< mean negative_share() of all probes
};

/// Marks probes that see more backs than fronts of surfaces, and backs in a quarter of all
/// directions: those are inside walls. Double-sided surfaces have no back.
std::vector<std::uint8_t> validity(pathtracer::PointTracer& tracer,
                                   std::span<const glm::dvec3> positions);

/// Encodes `format`'s integrals, which begin at `first` of each probe. Throws as light_of().
/// `dilate`: fills probes that are not valid. `threads`: 0 for one per processor; the result is the
/// same with any number.
BakedProbes encoded(const ProbeFormat& format, const GridLight& light, std::size_t first,
                    const ProbeGrid& grid, std::vector<std::uint8_t> valid, bool dilate,
                    int threads = 0);

// Errors of baked probes against path tracing, on surfaces and in the air (probe_check.cpp).

/// Random places in a grid that are not inside walls, and their true irradiance [W/m^2].
struct CheckPoints {
  std::vector<SurfacePoint> points;
  std::vector<glm::dvec3> truth;
};

/// `count` points of surfaces that are seen from such places; or `count` such places with six
/// normals each, along the axes of a random rotation. `direct`: with light of the scene's lights.
/// Fewer where most of the grid is inside walls.
CheckPoints surface_points(pathtracer::PointTracer& tracer, const ProbeGrid& grid,
                           std::size_t count, bool direct, double& noise);
CheckPoints air_points(pathtracer::PointTracer& tracer, const ProbeGrid& grid, std::size_t count,
                       bool direct, double& noise);

/// The points of a file.
CheckPoints given_points(pathtracer::PointTracer& tracer, std::vector<SurfacePoint> points,
                         bool direct, double& noise);

/// Errors over all points and channels.
struct ProbeError {
  double nrmse = 0;     ///< root mean square error over that of the truth; NaN in the dark
  double energy = 0;    ///< sum over that of the truth; NaN in the dark
  double negative = 0;  ///< share of points with a negative channel, which count as 0
  double mean = 0;      ///< irradiance [W/m^2], over all points and channels
};

/// `lift`: look-ups lie so many spacings along the normal.
ProbeError error_of(const ProbeFormat& format, const BakedProbes& baked, const CheckPoints& points,
                    double lift);

/// The lift on surfaces, three.js's.
inline constexpr double kSurfaceLift = 0.5;

}  // namespace clpv::bake
