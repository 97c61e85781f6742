// SPDX-License-Identifier: MIT
#include "bake/probe_source.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "basis/spherical_harmonics.hpp"
#include "options/validate.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/frame/frame.hpp"
#include "support/error.hpp"

namespace clpv::bake {
namespace {

constexpr double kOffSurfaces = 0.5;       // cells
constexpr std::size_t kTracedBlock = 512;  // probes
constexpr std::size_t kLevelProbes = 256;  // for the grid's mean light
constexpr std::size_t kPointsAtOnce = 1 << 16;

/// Directions of an icosahedron's vertices, which integrate polynomials of degree 5 exactly.
std::array<glm::dvec3, 12> twelve_directions() {
  std::array<glm::dvec3, 12> all;
  for (std::size_t i = 0; i < 12; ++i) {
    const int axis = static_cast<int>(i / 4);
    all[i] = glm::dvec3(0);
    all[i][axis] = (i & 1 ? -1 : 1) * std::numbers::phi;
    all[i][(axis + 1) % 3] = i & 2 ? -1 : 1;
    all[i] = glm::normalize(all[i]);
  }
  return all;
}

class Swept : public ProbeSource {
 public:
  Swept(Session& session, const SceneData& scene, const SceneCamera& camera,
        const RenderOptions& options, const ProbeGrid& grid,
        const std::vector<ProbeFormat>& formats, pathtracer::PointTracer& tracer)
      : session_(session),
        camera_(camera),
        grid_(grid),
        frame_(session, scene, options),
        places_(tracer.off_surfaces(positions_of(grid),
                                    kOffSurfaces * options.cascade_size / options.grid)),
        directions_(twelve_directions()) {
    if (options.transport != TransportKind::sweep)
      throw Error(ExitCode::usage, "transport: found '{}', allowed with --from sweep: sweep",
                  name_of(options.transport));
    frame_.require_lookups("bake");
    add_projection(formats);
    divide(options);
  }

  BlockLight light(std::size_t block) override {
    render_at(eyes_[block]);
    const std::vector<std::size_t>& probes = blocks_[block];
    BlockLight light;
    light.integrals.reserve(probes.size() * rows());
    constexpr std::size_t kProbes = kPointsAtOnce / 12;
    for (std::size_t first = 0; first < probes.size(); first += kProbes)
      append(std::span(probes).subspan(first, std::min(kProbes, probes.size() - first)), light);
    return light;
  }

 private:
  std::size_t rows() const { return static_cast<std::size_t>(projection_.rows()); }

  /// Weight of the radiance of each direction in each integral.
  void add_projection(const std::vector<ProbeFormat>& formats) {
    const SphericalHarmonics nine(3);
    Matrix samples(9, 12);
    for (int k = 0; k < 12; ++k) {
      const std::vector<double> y = nine.evaluate(directions_[static_cast<std::size_t>(k)]);
      for (int j = 0; j < 9; ++j) samples(j, k) = 4 * std::numbers::pi / 12 * y[j];
    }
    std::vector<Matrix> parts;
    int count = 0;
    for (const ProbeFormat& format : formats) {
      parts.push_back(of_harmonics(format) * samples);
      count += parts.back().rows();
    }
    projection_ = Matrix(count, 12);
    int row = 0;
    for (const Matrix& part : parts)
      for (int i = 0; i < part.rows(); ++i, ++row)
        for (int k = 0; k < 12; ++k) projection_(row, k) = part(i, k);
  }

  /// Divides the grid into boxes in which the finest cascade has full weight.
  void divide(const RenderOptions& options) {
    const double cell = options.cascade_size / options.grid, blend = GatherOptions().blend_cells,
                 reach = (grid_reach(options.grid) - blend) * cell;
    if (!(reach > 0))
      throw Error(ExitCode::usage,
                  "grid: found {} cells, of which none has full weight; allowed: {} or more",
                  options.grid, 2 * static_cast<int>(blend) + 3);
    glm::dvec3 edge;
    double frames = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double length = grid_.upper[axis] - grid_.lower[axis],
                   parts = std::max(1.0, std::ceil(length / (2 * reach) - 1e-9));
      edge[axis] = length / parts, frames *= parts;
    }
    if (frames > kMaxBakeFrames)
      throw Error(ExitCode::usage,
                  "bounds: found {:.4g} frames of cascades of {:.4g} m, allowed: at most {}; a "
                  "larger --cascade-size makes them fewer",
                  frames, options.cascade_size, kMaxBakeFrames);
    std::map<std::tuple<int, int, int>, std::vector<std::size_t>> parts;
    for (std::size_t i = 0; i < grid_.size(); ++i) {
      const glm::dvec3 at = grid_.position(i) - grid_.lower;
      const auto part = [&](int axis) {
        if (!(edge[axis] > 0)) return 0;
        const double last = std::round((grid_.upper[axis] - grid_.lower[axis]) / edge[axis]) - 1;
        return static_cast<int>(std::min(at[axis] / edge[axis], last));
      };
      parts[{part(2), part(1), part(0)}].push_back(i);
    }
    for (auto& [part, probes] : parts) {
      const auto [z, y, x] = part;
      eyes_.emplace_back(grid_.lower + (glm::dvec3(x, y, z) + 0.5) * edge);
      blocks_.push_back(std::move(probes));
    }
  }

  void render_at(const glm::dvec3& eye) {
    camera_.eye = glm::vec3(eye);
    const GivenPixels pixel{
        .width = 1,
        .height = 1,
        .points = true,
        .places = session_.upload(std::vector{glm::vec4(camera_.eye, 0)}, "position of a probe"),
        .normals = session_.upload(std::vector{glm::vec4(0, 1, 0, 0)}, "normal of a probe")};
    frame_.light(camera_, pixel);
  }

  void append(std::span<const std::size_t> probes, BlockLight& light) {
    std::vector<glm::vec4> positions, travels;
    for (const std::size_t probe : probes) {
      for (const glm::dvec3& direction : directions_) {
        positions.emplace_back(glm::vec3(places_[probe]), 0);
        travels.emplace_back(glm::vec3(-direction), 0);
      }
    }
    const std::vector<glm::vec4> radiance =
        frame_.radiance_at(std::move(positions), std::move(travels));
    for (std::size_t i = 0; i < probes.size(); ++i) {
      for (int row = 0; row < projection_.rows(); ++row) {
        glm::dvec3 sum(0);
        for (std::size_t k = 0; k < 12; ++k)
          sum += projection_(row, static_cast<int>(k)) * glm::dvec3(radiance[12 * i + k]);
        light.integrals.emplace_back(sum);
      }
    }
  }

  Session& session_;
  SceneCamera camera_;
  ProbeGrid grid_;
  Frame frame_;
  std::vector<glm::dvec3> places_;  // positions of probes, off surfaces
  std::array<glm::dvec3, 12> directions_;
  Matrix projection_;
  std::vector<glm::dvec3> eyes_;  // eyes of blocks
};

class Traced : public ProbeSource {
 public:
  Traced(pathtracer::PointTracer& tracer, const ProbeGrid& grid,
         const std::vector<ProbeFormat>& formats, bool fixed_samples)
      : tracer_(tracer), grid_(grid), moments_(joined(formats)) {
    for (std::size_t i = 0; i < grid.size(); ++i) {
      if (i % kTracedBlock == 0) blocks_.emplace_back();
      blocks_.back().push_back(i);
    }
    fixed_ = fixed_samples;
  }

  BlockLight light(std::size_t block) override {
    const auto traced =
        tracer_.probes(positions(blocks_[block]), moments_, blocks_[block].front(), level());
    BlockLight light;
    for (const glm::dvec3& value : traced.indirect) light.integrals.emplace_back(value);
    light.noise = static_cast<float>(traced.noise);
    light.samples = traced.samples;
    return light;
  }

 private:
  std::vector<glm::dvec3> positions(std::span<const std::size_t> probes) const {
    std::vector<glm::dvec3> all;
    for (const std::size_t probe : probes) all.push_back(grid_.position(probe));
    return all;
  }

  /// Root mean square of the integrals over the grid, from some of its probes.
  double level() {
    if (fixed_) return 0;
    if (level_ < 0) {
      std::vector<std::size_t> some;
      const std::size_t step = grid_.size() / kLevelProbes + 1;
      for (std::size_t i = 0; i < grid_.size(); i += step) some.push_back(i);
      level_ = tracer_.level(positions(some), moments_);
    }
    return level_;
  }

  pathtracer::PointTracer& tracer_;
  ProbeGrid grid_;
  Moments moments_;
  bool fixed_;
  double level_ = -1;
};

}  // namespace

std::unique_ptr<ProbeSource> swept_light(Session& session, const SceneData& scene,
                                         const SceneCamera& camera, const RenderOptions& options,
                                         const ProbeGrid& grid,
                                         const std::vector<ProbeFormat>& formats,
                                         pathtracer::PointTracer& tracer) {
  return std::make_unique<Swept>(session, scene, camera, options, grid, formats, tracer);
}

std::unique_ptr<ProbeSource> traced_light(pathtracer::PointTracer& tracer, const ProbeGrid& grid,
                                          const std::vector<ProbeFormat>& formats,
                                          bool fixed_samples) {
  return std::make_unique<Traced>(tracer, grid, formats, fixed_samples);
}

Moments joined(const std::vector<ProbeFormat>& formats) {
  std::vector<Moments> parts;
  std::size_t count = 0;
  for (const ProbeFormat& format : formats) {
    parts.push_back(format.moments);
    count += format.moments.count;
  }
  return {count, [parts](const glm::dvec3& w, std::span<double> g) {
            std::size_t first = 0;
            for (const Moments& part : parts) {
              part.weights(w, g.subspan(first, part.count));
              first += part.count;
            }
          }};
}

}  // namespace clpv::bake
