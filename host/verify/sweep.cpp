// SPDX-License-Identifier: MIT
// Sweep and bounces: kernels against CPU references. Checks use small cascades of random light,
// blockers and reflectors.
#include "basis/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "basis/bounce.hpp"
#include "kernels/shared/reflectors.h"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/raster/shadow_maps.hpp"
#include "pipeline/steps/transmittance.hpp"
#include "pipeline/sweep/sweep.hpp"
#include "pipeline/sweep/sweep_literals.hpp"
#include "pipeline/voxels/voxel_field.hpp"
#include "reference/bounce.hpp"
#include "reference/medium.hpp"
#include "reference/sweep.hpp"
#include "verify/check.hpp"
#include "verify/inputs.hpp"
#include "verify/jobs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::verify {
namespace {

constexpr double kEdge = 4;  // edge of the finest grid [m]
constexpr float kSkyScale = 0.5f;

/// Its box cuts cells of every cascade.
const ClpvMedium kSweptMedium{
    {-1.1f, -0.7f, -3.3f}, {1.3f, 4, 0.9f}, {0.1f, 0.4f, 0.3f}, {0.2f, 0.4f, 2}, 0.4f, {}};
constexpr float kMediumScale = 0.25f;

SweepOptions with_sky(const SweepProblem& problem) {
  SweepOptions options = problem.options;
  options.sky = problem.sky ? &*problem.sky : nullptr;
  options.points = !problem.occluded.empty();
  return options;
}

/// Volumes and kernels of one sweep.
struct SweepWork {
  SweepProblem problem;
  std::vector<Volume> light, blockers, white, reflectors, swept;
  std::vector<ShadowedLight> lights;
  Buffer occluded;
  Sweeper sweeper;

  SweepWork(Session& session, const SweepProblem& p)
      : problem(p),
        lights(scaled(on_device(session, p.lights), p.medium_scale)),
        sweeper(session, *p.basis, problem.transport, with_sky(problem)) {
    const SweepOptions& o = p.options;
    std::vector<std::uint8_t> bits;
    for (const auto& cascade : p.occluded) bits.insert(bits.end(), cascade.begin(), cascade.end());
    if (!bits.empty()) occluded = session.upload(bits, "occluded cells");
    for (std::size_t i = 0; i < p.grids.size(); ++i) {
      light.push_back(on_device(session, *p.light[i], o.format));
      if (o.blocking) blockers.push_back(on_device(session, *p.blockers[i], o.format));
      if (bounces()) reflectors.push_back(on_device(session, *p.reflectors[i], o.format));
      if (!p.white.empty()) white.push_back(on_device(session, *p.white[i], o.format));
      const int channels = p.white.empty() ? 3 : 4;
      swept.emplace_back(session, VolumeShape{o.grid, swept_basis()->size(), channels},
                         "swept light", o.format);
    }
  }
  bool bounces() const { return problem.options.bounces != Bounces::one; }

  void run() {
    for (std::size_t i = problem.grids.size(); i-- > 0;) {
      if (problem.options.blocking) sweeper.set_blockers(i, problem.grids, &blockers[i], occluded);
      if (!white.empty())
        sweeper.set_surfaces(i, problem.grids, white[i], bounces() ? &reflectors[i] : nullptr,
                             swept[i]);
      sweeper.sweep({i, problem.grids, light[i], problem.sky_scale, lights}, swept[i]);
    }
  }
};

/// Expected light of all cascades.
std::vector<double> expected_light(const SweepProblem& p) {
  const SweepOptions& o = p.options;
  std::vector<reference::Volume> scattered(p.grids.size());
  std::vector<reference::SweptCascade> cascades;
  std::vector<const reference::Volume*> white, reflecting;
  for (std::size_t i = 0; i < p.grids.size(); ++i) {
    cascades.push_back(
        {p.grids[i], p.light[i].get(), o.blocking ? p.blockers[i].get() : nullptr, o.parts[i]});
    if (!p.occluded.empty()) cascades.back().occluded = &p.occluded[i];
    if (!p.white.empty()) white.push_back(p.white[i].get());
    if (o.bounces != Bounces::one) reflecting.push_back(p.reflectors[i].get());
    if (!o.medium) continue;
    scattered[i] = reference::scattered_in_cells(*o.medium, p.lights, p.grids[i]);
    for (double& source : scattered[i].values) source *= double{p.medium_scale};
    cascades.back().medium = &*o.medium, cascades.back().scattered = &scattered[i];
  }
  std::optional<Sky> sky = p.sky;
  if (sky)
    for (glm::vec3& texel : sky->texels) texel *= p.sky_scale;
  std::vector<reference::Volume> normalised;
  if (o.bounces != Bounces::one)
    normalised = reference::normalised_reflectors(*p.basis, p.transport, cascades, white,
                                                  reflecting, o.bounces, o.most_white);
  for (std::size_t i = 0; i < normalised.size(); ++i) reflecting[i] = &normalised[i];
  const std::vector<reference::Volume> swept =
      o.bounces == Bounces::one
          ? reference::sweep(*p.basis, p.transport, cascades, sky ? &*sky : nullptr)
          : reference::sweep_bounced(*p.basis, p.transport, cascades, reflecting, o.bounces,
                                     o.bounce_sweeps);
  std::vector<reference::Volume> furnace;
  if (!white.empty())
    furnace = reference::furnace(*p.basis, p.transport, cascades, white, o.most_white);
  std::vector<double> values;
  for (std::size_t i = 0; i < swept.size(); ++i) {
    const reference::Volume light = reference::project_bins(swept[i]);
    values.insert(values.end(), light.values.begin(), light.values.end());
    if (furnace.empty()) continue;
    const reference::Volume even = reference::project_bins(furnace[i]);
    values.insert(values.end(), even.values.begin(), even.values.begin() + even.values.size() / 3);
  }
  return values;
}

struct SweepCase {
  std::string basis;
  int grid;
  std::vector<int> parts;  ///< one per cascade
  Bounces bounces = Bounces::one;
  bool blocking = true;
  Blocking blocked_by = Blocking::areas;
  VolumeFormat format = {};
  SweepForm form = SweepForm::bins;
  bool sky = false;
  bool medium = false;
  bool closed = false;  ///< links by sample points
  int sweeps = kSeriesSweeps;

  std::string name() const {
    std::string directions;
    for (const int p : parts)
      directions += fmt::format("{}{}", directions.empty() ? "" : ",", kSweepBins * p * p);
    return fmt::format("{}/{}^3/{}{}{}{}{}{}{}{}{}/{}", basis, grid, directions,
                       bounces == Bounces::one ? "" : fmt::format("/{} bounces", name_of(bounces)),
                       sweeps == kSeriesSweeps ? "" : fmt::format("/{} sweeps", sweeps),
                       blocking ? "" : "/free", blocked_by == Blocking::areas ? "" : "/one-sided",
                       form == SweepForm::bins ? "" : fmt::format("/{}", name_of(form)),
                       sky ? "/sky" : "", medium ? "/medium" : "", closed ? "/closed" : "",
                       format_name(format));
  }
};

/// A sky that is dark below, with varied colours above.
Sky uneven_sky() {
  Sky sky;
  sky.width = 5, sky.height = 4, sky.rotation = 0.7;
  sky.texels.assign(20, glm::vec3(0));
  for (int i = 0; i < 12; ++i) sky.texels[i] = glm::vec3(i % 4, i % 3, 0.3f * i);
  return sky;
}

/// Random light in the first cell and in 1 of 30: rows with and without sources.
SharedVolume sparse_light(const Basis& basis, int n, std::mt19937& random) {
  const std::shared_ptr<reference::Volume> light = random_light(basis, n, random);
  reference::for_each_cell(n, [&](const glm::ivec3& p) {
    if (p == glm::ivec3(0) || random() % 30 == 0) return;
    for (int channel = 0; channel < 3; ++channel)
      light->set_cell(channel, p, std::vector<double>(basis.size(), 0.0));
  });
  return light;
}

/// 1 of 3 faces reflects, with an albedo of up to 0.5 and a share of 0.6 to 1; 1 of 3 cells lie
/// along the grid.
SharedVolume random_reflectors(int n, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-2, 1);
  auto volume = std::make_shared<reference::Volume>(n, kCellFaces, CLPV_REFLECTOR_CHANNELS);
  const auto area = volume->values.begin() +
                    static_cast<std::ptrdiff_t>(volume->index(CLPV_REFLECTOR_AREA, 0, 0, 0, 0));
  for (auto value = volume->values.begin(); value != area; ++value)
    *value = std::max(0.0f, uniform(random));
  std::copy(area - std::distance(area, volume->values.end()), area, area);
  reference::for_each_cell(n, [&](const glm::ivec3& p) {
    for (int side = 0; side < kCellFaces; ++side) {
      const float share = 0.6f + 0.2f * std::abs(uniform(random));
      volume->at(CLPV_REFLECTOR_SHARE, side, p.x, p.y, p.z) = p.z % 3 == 0 ? 1 : share;
      const double white = volume->value(CLPV_REFLECTOR_WHITE, side, p.x, p.y, p.z);
      for (int channel = 0; channel < 3; ++channel) {
        double& reflected = volume->at(channel, side, p.x, p.y, p.z);
        reflected = std::min(reflected, 0.5 * white);
      }
    }
  });
  return volume;
}

/// Occlusion of one cascade. In 2 of 3 cubes each point is hidden from one of two groups of
/// centres, so that links between the groups are closed. 1 of 10 centres is enclosed: it sees no
/// point inside the grid.
std::vector<std::uint8_t> random_walls(int n, std::mt19937& random) {
  constexpr int kPoints = 64;
  std::vector<std::uint8_t> occluded(visibility_bytes(n));
  for (std::size_t cube = 0; cube < occluded.size(); cube += kPoints) {
    const auto number = static_cast<int>(cube / kPoints);
    // The last cubes along each axis lie outside the grid.
    const bool outside = std::max({number % n, number / n % n, number / n / n}) == n - 1;
    const std::uint8_t group = random() % 256, walls = outside || random() % 3 == 0 ? 0 : 255;
    for (int point = 0; point < kPoints; ++point)
      occluded[cube + point] = walls & (point < kPoints / 2 ? group : 255 - group);
  }
  reference::for_each_cell(n, [&](const glm::ivec3& p) {
    if (random() % 10 != 0) return;
    for (int octant = 0; octant < 8; ++octant) {
      const glm::ivec3 cube = p - 1 + glm::ivec3(octant & 1, octant >> 1 & 1, octant >> 2);
      if (glm::any(glm::lessThan(cube, glm::ivec3(0))) ||
          glm::any(glm::greaterThan(cube, glm::ivec3(n - 2))))
        continue;
      const auto first = static_cast<std::size_t>((cube.z * n + cube.y) * n + cube.x) * kPoints;
      for (int point = 0; point < kPoints; ++point) occluded[first + point] |= 1 << (7 - octant);
    }
  });
  return occluded;
}

Job job_of(Session& session, const SweepCase& c) {
  const std::shared_ptr<const Basis> basis = make_basis(c.basis);
  SweepProblem problem =
      random_sweep(basis, make_transport(TransportKind::sweep, *basis, {}, c.blocked_by),
                   {.grid = c.grid,
                    .parts = c.parts,
                    .blocking = c.blocking,
                    .most_white = c.blocking ? kNoLimitOfWhite : 1,
                    .bounces = c.bounces,
                    .bounce_sweeps = c.sweeps,
                    .format = c.format,
                    .form = c.form,
                    .medium = c.medium ? std::optional(kSweptMedium) : std::nullopt});
  std::mt19937 random(5);
  for (std::size_t i = 0; c.closed && i < c.parts.size(); ++i)
    problem.occluded.push_back(random_walls(c.grid, random));
  if (c.sky) problem.sky = uneven_sky(), problem.sky_scale = kSkyScale;
  return sweep_job(session, problem);
}

Cases named_cases(Stage stage, const std::vector<SweepCase>& all) {
  Cases cases;
  for (const SweepCase& c : all)
    cases.push_back(
        job_case(stage, c.name(), [c](Session& session) { return job_of(session, c); }));
  return cases;
}

}  // namespace

Job sweep_job(Session& session, const SweepProblem& problem, const Share& share) {
  const auto p = std::make_shared<SweepWork>(session, problem);
  Job job;
  job.reset = [p, &session] {
    for (Volume& volume : p->swept) volume.clear(session);
  };
  job.run = [p] { p->run(); };
  job.compare = [p, &session, share] {
    const SweepOptions& o = p->problem.options;
    const Values expected = share([&] { return expected_light(p->problem); });
    Deviation result{0, tolerance(p->bounces() ? "bounce" : "sweep", o.format.storage)};
    for (std::size_t i = 0; i < p->swept.size(); ++i) {
      const std::vector<float> found = p->swept[i].read(session);
      const auto wanted = std::span(*expected).subspan(i * found.size(), found.size());
      expect(session, p->swept[i], ranges_about(wanted, result.allowed));
      const Deviation apart = compare_volumes(found, wanted, o.grid);
      result.take(apart.worst, [&] { return fmt::format("cascade {} {}", i, apart.place); });
    }
    return result;
  };
  return job;
}

SweepProblem random_sweep(const std::shared_ptr<const Basis>& basis, const Transport& transport,
                          const SweepOptions& options) {
  std::mt19937 random(3);
  const float cell = kEdge / options.grid;
  const int count = options.parts.size();
  SweepProblem problem{basis, transport, options, {}, {}, {}, {}, {}};
  problem.grids = cascade_grids(cell * glm::vec3(0.5f, 1.5f, 2.5f), count, kEdge, options.grid);
  for (int i = 0; i < count; ++i) {
    problem.light.push_back(sparse_light(*basis, options.grid, random));
    problem.blockers.push_back(
        random_blockers(blocking_size(transport.blocking, *basis), options.grid, random));
    problem.reflectors.push_back(random_reflectors(options.grid, random));
    problem.white.push_back(random_reflectors(options.grid, random));
  }
  if (options.medium)
    problem.lights = lights_in(*options.medium), problem.medium_scale = kMediumScale;
  return problem;
}

Cases sweep_cases(const CheckScope& scope) {
  // Cases of one grid size and basis share kernels.
  std::vector<SweepCase> cases = {
      {.basis = "sh3", .grid = 9, .parts = {2, 1, 1}, .closed = true},
      {.basis = "sh3", .grid = 9, .parts = {1, 3}, .form = SweepForm::groups, .sky = true},
      {.basis = "bins24", .grid = 9, .parts = {1, 2}, .sky = true},
      {.basis = "sh2", .grid = 8, .parts = {1, 1}, .blocked_by = Blocking::one_sided},
      {.basis = "sh2", .grid = 9, .parts = {3, 2}, .blocking = false},
      {.basis = "srbf8v2", .grid = 1, .parts = {1, 1}},
      {.basis = "sh3", .grid = 9, .parts = {2, 1}, .medium = true},
      {.basis = "sh3", .grid = 9, .parts = {1, 1}, .form = SweepForm::planes, .medium = true},
  };
  for (const VolumeFormat& format : scope.formats)
    cases.push_back({.basis = "sh3", .grid = 9, .parts = {1, 1}, .format = format});
  if (scope.thorough) {
    cases.push_back({.basis = "sh3", .grid = 8, .parts = {2, 2}, .form = SweepForm::planes});
    cases.push_back({.basis = "bins24", .grid = 7, .parts = {1, 1, 2}, .form = SweepForm::planes});
    for (const std::string& name : basis_names()) {
      for (const int parts : {1, 2, 3, 4})
        cases.push_back({.basis = name, .grid = 6, .parts = {parts, 1}});
    }
  }
  return named_cases(Stage::sweep, cases);
}

Cases bounce_cases(const CheckScope& scope) {
  const Bounces all = Bounces::all;
  std::vector<SweepCase> cases = {
      {.basis = "sh3", .grid = 9, .parts = {2, 1}, .bounces = all, .closed = true},
      {.basis = "sh3",
       .grid = 9,
       .parts = {1, 3},
       .bounces = Bounces::two,
       .form = SweepForm::planes},
      {.basis = "sh3", .grid = 9, .parts = {2, 1}, .bounces = all, .medium = true},
  };
  // Stage `sweep` compares the sweep in every format, so without `thorough` only one layout of
  // buffers and images follow.
  for (const VolumeFormat& format : scope.formats) {
    if (!scope.thorough && format.layout != Layout::soa && format.layout != Layout::image) continue;
    cases.push_back({.basis = "sh3", .grid = 9, .parts = {1, 1}, .bounces = all, .format = format});
  }
  if (scope.thorough) {
    cases.push_back({.basis = "sh2",
                     .grid = 7,
                     .parts = {1, 2, 1},
                     .bounces = all,
                     .form = SweepForm::planes,
                     .sweeps = 5});
    cases.push_back({.basis = "bins24",
                     .grid = 8,
                     .parts = {2, 2},
                     .bounces = Bounces::two,
                     .form = SweepForm::planes});
    cases.push_back({.basis = "srbf8v2", .grid = 1, .parts = {1}, .bounces = all});
    cases.push_back(
        {.basis = "sh3", .grid = 7, .parts = {1, 2}, .bounces = Bounces::two, .medium = true});
    for (const std::string& name : basis_names())
      cases.push_back({.basis = name, .grid = 6, .parts = {2, 1}, .bounces = all});
  }
  return named_cases(Stage::bounce, cases);
}

}  // namespace clpv::verify
