// SPDX-License-Identifier: MIT
#include "bake/bake.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <regex>
#include <tuple>

#include "basis/bases.hpp"
#include "options/render_options.hpp"
#include "parallel/ranks.hpp"
#include "pathtracer/tracing.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/frame/frame.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/progress.hpp"

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

constexpr double kBacks = 0.25;                    // share of all directions
constexpr std::uint64_t kMaxOldBlocks = 1u << 30;  // bytes
constexpr std::chrono::hours kMaxAge(24 * 30);

void require_finite(const glm::vec3& light, const ProbeGrid& grid, std::size_t probe) {
  if (std::isfinite(light.x) && std::isfinite(light.y) && std::isfinite(light.z)) return;
  const glm::dvec3 at = grid.position(probe);
  throw Error(
      ExitCode::run_time,
      "probe at ({:.4g}, {:.4g}, {:.4g}): found light of {}, {}, {}, allowed: finite floats", at.x,
      at.y, at.z, light.x, light.y, light.z);
}

/// Mean of the neighbours that are known, weighted by the inverse square of their distance; false
/// without one.
bool fill(const ProbeGrid& grid, std::size_t probe, std::size_t n,
          const std::vector<std::uint8_t>& known, std::vector<glm::vec3>& coefficients) {
  const glm::ivec3 at = grid.at(probe);
  const glm::dvec3 spacing = grid.spacing();
  std::vector<glm::dvec3> sum(n, glm::dvec3(0));
  double weights = 0;
  for (int i = 0; i < 27; ++i) {
    const glm::ivec3 off(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1), place = at + off;
    if (off == glm::ivec3(0) || glm::any(glm::lessThan(place, glm::ivec3(0))) ||
        glm::any(glm::greaterThanEqual(place, grid.count)))
      continue;
    const std::size_t other = grid.index(place);
    if (!known[other]) continue;
    const glm::dvec3 apart = glm::dvec3(off) * spacing;
    const double weight = 1 / glm::dot(apart, apart);
    weights += weight;
    for (std::size_t k = 0; k < n; ++k) sum[k] += weight * glm::dvec3(coefficients[other * n + k]);
  }
  if (weights == 0) return false;
  for (std::size_t k = 0; k < n; ++k) coefficients[probe * n + k] = glm::vec3(sum[k] / weights);
  return true;
}

/// Calls action(i) for i below `count`, on threads (0: one per processor). Throws Interrupted.
void for_all(std::size_t count, int threads, const char* title,
             const std::function<void(std::size_t)>& action) {
  constexpr std::size_t kBatch = 256;
  Progress progress(title, count);
  std::atomic<std::size_t> next{0};
  pathtracer::on_threads(threads > 0 ? threads : single_rank().processors(),
                         [&, stop = current_stop()](const std::atomic<bool>& failed) {
                           const StopScope scope(stop);
                           for (std::size_t first; !failed && !interrupted() &&
                                                   (first = next.fetch_add(kBatch)) < count;) {
                             const std::size_t end = std::min(first + kBatch, count);
                             for (std::size_t i = first; i < end; ++i) action(i);
                             progress.advance(end - first);
                           }
                         });
  stop_if_interrupted();
}

/// Fills unknown probes from known ones, layer by layer.
void dilate_into(const ProbeGrid& grid, std::size_t n, std::vector<std::uint8_t> known,
                 std::vector<glm::vec3>& coefficients, int threads) {
  std::vector<std::size_t> unknown;
  for (std::size_t probe = 0; probe < grid.size(); ++probe)
    if (!known[probe]) unknown.push_back(probe);
  for (std::size_t before = 0; unknown.size() != before;) {
    before = unknown.size();
    std::vector<std::uint8_t> next = known;
    for_all(before, threads, "filling probes", [&](std::size_t i) {
      if (fill(grid, unknown[i], n, known, coefficients)) next[unknown[i]] = 1;
    });
    known = std::move(next);
    std::erase_if(unknown, [&](std::size_t probe) { return known[probe] != 0; });
  }
}

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

BlockCache::BlockCache(const std::optional<std::filesystem::path>& folder, std::string key)
    : key_(std::move(key)) {
  if (!folder) return;
  folder_.emplace(*folder / "bakes");
  // Names of name_of(), and of the OutputFiles of killed processes.
  static const std::regex kOwn(R"([0-9a-z]+-\d+\.block|\.[0-9a-z]+-\d+\.block\.\d+-\d+\.part)");
  folder_->evict(kOwn, kMaxOldBlocks, kMaxAge);
}

std::string BlockCache::name_of(std::size_t block) const {
  return fmt::format("{}-{}.block", key_, block);
}

std::optional<BlockLight> BlockCache::read(std::size_t block, std::size_t numbers) const {
  if (!folder_) return std::nullopt;
  const std::size_t size = numbers * sizeof(glm::vec3);
  BlockLight light;
  const std::size_t head = sizeof light.noise + sizeof light.samples;
  const auto bytes = folder_->read_checked(name_of(block));
  if (!bytes || bytes->size() != head + size) return std::nullopt;
  light.integrals.resize(numbers);
  std::memcpy(&light.noise, bytes->data(), sizeof light.noise);
  std::memcpy(&light.samples, bytes->data() + sizeof light.noise, sizeof light.samples);
  if (numbers > 0) std::memcpy(light.integrals.data(), bytes->data() + head, size);
  return light;
}

void BlockCache::write(std::size_t block, const BlockLight& light) {
  if (!folder_) return;
  std::string bytes;
  const auto add = [&](const void* from, std::size_t size) {
    bytes.append(static_cast<const char*>(from), size);
  };
  add(&light.noise, sizeof light.noise), add(&light.samples, sizeof light.samples);
  add(light.integrals.data(), light.integrals.size() * sizeof(glm::vec3));
  const std::string problem = folder_->write_checked(name_of(block), std::move(bytes));
  if (problem.empty()) return;
  log_warning("{}: an interrupted bake will begin again", problem);
  folder_.reset();
}

void BlockCache::clear(std::size_t count) {
  if (!folder_) return;
  for (std::size_t block = 0; block < count; ++block) {
    std::error_code ignored;
    std::filesystem::remove(folder_->path() / name_of(block), ignored);
  }
}

GridLight light_of(ProbeSource& source, const ProbeGrid& grid, std::size_t count, BlockCache& cache,
                   const std::function<void(std::size_t)>& done) {
  GridLight all;
  all.count = count;
  all.integrals.resize(grid.size() * count);
  double squares = 0;
  const auto& blocks = source.blocks();
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    stop_if_interrupted();
    std::optional<BlockLight> light = cache.read(block, blocks[block].size() * count);
    if (!light) {
      light = source.light(block);
      for (std::size_t i = 0; i < light->integrals.size(); ++i)
        require_finite(light->integrals[i], grid, blocks[block][i / count]);
      cache.write(block, *light);
    }
    for (std::size_t i = 0; i < blocks[block].size(); ++i)
      std::copy_n(light->integrals.begin() + static_cast<std::ptrdiff_t>(i * count), count,
                  all.integrals.begin() + static_cast<std::ptrdiff_t>(blocks[block][i] * count));
    all.samples = std::max(all.samples, light->samples);
    squares += double{light->noise} * double{light->noise} * double(blocks[block].size());
    done(block + 1);
  }
  all.noise = std::sqrt(squares / double(grid.size()));
  return all;
}

std::vector<std::uint8_t> validity(pathtracer::PointTracer& tracer,
                                   std::span<const glm::dvec3> positions) {
  std::vector<std::uint8_t> valid;
  for (const auto& [backs, open] : tracer.surroundings(positions))
    valid.push_back(backs >= kBacks && backs > 1 - open - backs ? 0 : 1);
  return valid;
}

BakedProbes encoded(const ProbeFormat& format, const GridLight& light, std::size_t first,
                    const ProbeGrid& grid, std::vector<std::uint8_t> valid, bool dilate,
                    int threads) {
  BakedProbes baked{.grid = grid, .coefficients = {}, .valid = std::move(valid)};
  baked.filled = dilate && std::ranges::count(baked.valid, 1) > 0;
  baked.coefficients.resize(grid.size() * format.size);
  for_all(grid.size(), threads, "encoding", [&](std::size_t probe) {
    std::vector<glm::dvec3> integrals(format.moments.count);
    for (std::size_t i = 0; i < integrals.size(); ++i)
      integrals[i] = glm::dvec3(light.integrals[probe * light.count + first + i]);
    const std::vector<glm::dvec3> made = format.encoded(integrals);
    for (std::size_t i = 0; i < format.size; ++i) {
      const glm::vec3 coefficient(made[i]);
      require_finite(coefficient, grid, probe);
      baked.coefficients[probe * format.size + i] = coefficient;
    }
  });
  if (dilate) dilate_into(grid, format.size, baked.valid, baked.coefficients, threads);
  std::vector<double> negative(grid.size());
  for_all(grid.size(), threads, "checking normals", [&](std::size_t probe) {
    const auto of = std::span(baked.coefficients).subspan(probe * format.size, format.size);
    negative[probe] = negative_share(format, std::vector<glm::dvec3>(of.begin(), of.end()));
  });
  for (const double share : negative) baked.negative += share / static_cast<double>(grid.size());
  return baked;
}

}  // namespace clpv::bake
