// SPDX-License-Identifier: MIT
// Sweep and bounces: kernels against CPU references, on small cascades of random light, blockers and reflectors.
#include "basis/sweep.hpp"

#include <fmt/format.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "basis/bounce.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/sweep/sweep.hpp"
#include "reference/bounce.hpp"
#include "reference/medium.hpp"
#include "verify/check.hpp"
#include "verify/inputs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::reference {
namespace {

constexpr double kEdge = 4;  // edge of the finest grid [m]
constexpr float kSkyScale = 0.5f;

/// Its box cuts cells of every cascade.
const ClpvMedium kSweptMedium{
    {-1.1f, -0.7f, -3.3f}, {1.3f, 4, 0.9f}, {0.1f, 0.4f, 0.3f}, {0.2f, 0.4f, 2}, 0.4f, {}};
constexpr float kMediumScale = 0.25f;

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

  std::string name() const {
    std::string directions;
    for (const int p : parts)
      directions += fmt::format("{}{}", directions.empty() ? "" : ",", kSweepBins * p * p);
    return fmt::format("{}/{}^3/{}{}{}{}{}{}{}/{}", basis, grid, directions,
                       bounces == Bounces::one ? "" : fmt::format("/{} bounces", name_of(bounces)),
                       blocking ? "" : "/free", blocked_by == Blocking::areas ? "" : "/one-sided",
                       form == SweepForm::planes ? "/planes" : "", sky ? "/sky" : "", medium ? "/medium" : "",
                       format_name(format));
  }
};

/// A sky that is dark below, with varied colours above.
Sky uneven_sky(float scale) {
  Sky sky;
  sky.width = 5, sky.height = 4, sky.rotation = 0.7;
  sky.texels.assign(20, glm::vec3(0));
  for (int i = 0; i < 12; ++i) sky.texels[i] = scale * glm::vec3(i % 4, i % 3, 0.3f * i);
  return sky;
}

/// Random light in the first cell and in 1 of 30: rows with and without sources.
Volume sparse_light(const Basis& basis, int n, std::mt19937& random) {
  Volume light = random_light(basis, n, random);
  for_each_cell(n, [&](const glm::ivec3& p) {
    if (p == glm::ivec3(0) || random() % 30 == 0) return;
    for (int channel = 0; channel < 3; ++channel)
      light.set_cell(channel, p, std::vector<double>(basis.size(), 0.0));
  });
  return light;
}

/// 1 of 3 faces reflects.
Volume random_reflectors(int n, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-2, 1);
  Volume volume(n, kCellFaces);
  for (double& value : volume.values) value = std::max(0.0f, uniform(random));
  return volume;
}

CheckResult check_one(Session& session, const SweepCase& c, const char* stage) {
  std::mt19937 random(3);
  const std::unique_ptr<Basis> basis = make_basis(c.basis);
  const Transport transport = make_transport(TransportKind::sweep, *basis, {}, c.blocked_by);
  const int count = c.parts.size();
  const float cell = kEdge / c.grid;
  const std::vector<ClpvGrid> grids = cascade_grids(cell * glm::vec3(0.5f, 1.5f, 2.5f), count, kEdge, c.grid);
  const Sky unscaled_sky = uneven_sky(1);
  Sweeper sweeper(session, *basis, transport,
                  {.grid = c.grid,
                   .parts = c.parts,
                   .blocking = c.blocking,
                   .bounces = c.bounces,
                   .format = c.format,
                   .form = c.form,
                   .medium = c.medium ? std::optional(kSweptMedium) : std::nullopt,
                   .sky = c.sky ? &unscaled_sky : nullptr});
  const std::vector<MappedLight> in_medium = lights_in(kSweptMedium);
  const std::vector<ShadowedLight> shadowed = scaled(on_device(session, in_medium), kMediumScale);
  std::vector<Volume> lights, blockers, reflectors, scattered(count);
  std::vector<SweptCascade> cascades;
  std::vector<const Volume*> reflecting;
  for (int i = 0; i < count; ++i) {
    lights.push_back(sparse_light(*basis, c.grid, random));
    blockers.push_back(random_blockers(blocking_size(c.blocked_by, *basis), c.grid, random));
    reflectors.push_back(random_reflectors(c.grid, random));
    if (!c.medium) continue;
    scattered[i] = scattered_in_cells(kSweptMedium, in_medium, grids[i]);
    for (double& source : scattered[i].values) source *= double{kMediumScale};
  }
  for (int i = 0; i < count; ++i) {
    cascades.push_back({grids[i], &lights[i], c.blocking ? &blockers[i] : nullptr, c.parts[i],
                        c.medium ? &kSweptMedium : nullptr, c.medium ? &scattered[i] : nullptr});
    reflecting.push_back(&reflectors[i]);
  }
  std::vector<std::vector<float>> found(count);
  for (int i = count; i-- > 0;) {
    const clpv::Volume light = on_device(session, lights[i], c.format),
                       geometry = on_device(session, blockers[i], c.format),
                       sides = on_device(session, reflectors[i], c.format);
    clpv::Volume swept(session, {c.grid, swept_basis()->size(), 3}, "check: swept", c.format);
    if (c.blocking) sweeper.set_blockers(i, geometry);
    if (c.bounces != Bounces::one) sweeper.set_reflectors(i, grids[i], sides);
    sweeper.sweep({static_cast<std::size_t>(i), grids, light, kSkyScale, shadowed}, swept);
    found[i] = swept.read(session);
  }
  const Sky sky = uneven_sky(kSkyScale);
  const std::vector<Volume> expected =
      c.bounces == Bounces::one ? sweep(*basis, transport, cascades, c.sky ? &sky : nullptr)
                                : sweep_bounced(*basis, transport, cascades, reflecting, c.bounces);
  CheckResult result{stage, c.name(), 0, tolerance(stage, c.format.storage), {}};
  for (int i = 0; i < count; ++i) {
    const Comparison apart = compare_volumes(found[i], project_bins(expected[i]).values, c.grid);
    result.take(apart.worst, [&] { return fmt::format("cascade {} {}", i, apart.place); });
  }
  return result;
}

CheckResults check_all(Session& session, const CheckScope& scope, const std::vector<SweepCase>& cases,
                       const char* stage) {
  CheckResults results;
  for (const SweepCase& c : cases)
    compare_selected(scope, stage, c.name(), results, [&] { return check_one(session, c, stage); });
  return results;
}

}  // namespace

CheckResults check_sweep(Session& session, const CheckScope& scope) {
  // Cases of one grid size and basis share kernels.
  std::vector<SweepCase> cases = {
      {.basis = "sh3", .grid = 9, .parts = {2, 1, 1}},
      {.basis = "sh3", .grid = 9, .parts = {1, 3}, .form = SweepForm::planes, .sky = true},
      {.basis = "bins24", .grid = 9, .parts = {1, 2}, .sky = true},
      {.basis = "sh2", .grid = 8, .parts = {1, 1}, .blocked_by = Blocking::one_sided},
      {.basis = "sh3", .grid = 9, .parts = {3, 2}, .blocking = false},
      {.basis = "srbf8v2", .grid = 1, .parts = {1, 1}},
      {.basis = "sh3", .grid = 9, .parts = {2, 1}, .medium = true},
      {.basis = "sh3", .grid = 9, .parts = {1, 1}, .form = SweepForm::planes, .medium = true},
  };
  for (const VolumeFormat& format : other_formats(session.device(), {9, kSweepBins, 3}, scope.formats))
    cases.push_back({.basis = "sh3", .grid = 9, .parts = {1, 1}, .format = format});
  if (scope.thorough) {
    cases.push_back({.basis = "sh3", .grid = 8, .parts = {2, 2}, .form = SweepForm::planes});
    cases.push_back({.basis = "bins24", .grid = 7, .parts = {1, 1, 2}, .form = SweepForm::planes});
    for (const std::string& name : basis_names()) {
      for (const int parts : {1, 2, 3, 4}) cases.push_back({.basis = name, .grid = 6, .parts = {parts, 1}});
    }
  }
  return check_all(session, scope, cases, "sweep");
}

CheckResults check_bounce(Session& session, const CheckScope& scope) {
  const Bounces all = Bounces::all;
  std::vector<SweepCase> cases = {
      {.basis = "sh3", .grid = 9, .parts = {2, 1}, .bounces = all},
      {.basis = "sh3", .grid = 9, .parts = {1, 3}, .bounces = Bounces::two, .form = SweepForm::planes},
      {.basis = "sh3", .grid = 9, .parts = {2, 1}, .bounces = all, .medium = true},
  };
  // check_sweep compares the sweep in every format, so without `thorough` only one layout of buffers and images follow.
  for (const VolumeFormat& format : other_formats(session.device(), {9, kSweepBins, 3}, scope.formats)) {
    if (!scope.thorough && format.layout != Layout::soa && format.layout != Layout::image) continue;
    cases.push_back({.basis = "sh3", .grid = 9, .parts = {1, 1}, .bounces = all, .format = format});
  }
  if (scope.thorough) {
    cases.push_back(
        {.basis = "sh2", .grid = 7, .parts = {1, 2, 1}, .bounces = all, .form = SweepForm::planes});
    cases.push_back(
        {.basis = "bins24", .grid = 8, .parts = {2, 2}, .bounces = Bounces::two, .form = SweepForm::planes});
    cases.push_back({.basis = "srbf8v2", .grid = 1, .parts = {1}, .bounces = all});
    cases.push_back({.basis = "sh3", .grid = 7, .parts = {1, 2}, .bounces = Bounces::two, .medium = true});
    for (const std::string& name : basis_names())
      cases.push_back({.basis = name, .grid = 6, .parts = {2, 1}, .bounces = all});
  }
  return check_all(session, scope, cases, "bounce");
}

}  // namespace clpv::reference
