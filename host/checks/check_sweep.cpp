// SPDX-License-Identifier: MIT
// The sweep: kernels against the twin, on small cascades of random light and random blockers.
#include <fmt/format.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "basis/sweep.hpp"
#include "checks/check.hpp"
#include "checks/check_inputs.hpp"
#include "checks/tolerances.hpp"
#include "pipeline/cascade.hpp"
#include "pipeline/sweep.hpp"
#include "reference/sweep.hpp"

namespace clpv::reference {
namespace {

constexpr double kEdge = 4;  // of the finest grid [m]

struct Case {
  std::string basis;
  int grid;
  std::vector<int> parts;
  bool blocking = true;
  Blocking blocked_by = Blocking::areas;
  VolumeFormat format = {};
  SweepForm form = SweepForm::bins;
  bool sky = false;

  std::string name() const {
    std::string directions;
    for (const int p : parts)
      directions += fmt::format("{}{}", directions.empty() ? "" : ",", kSweepBins * p * p);
    return fmt::format("{}/{}^3/{}{}{}{}{}/{}", basis, grid, directions, blocking ? "" : "/free",
                       blocked_by == Blocking::areas ? "" : "/one-sided",
                       form == SweepForm::planes ? "/planes" : "", sky ? "/sky" : "", format_name(format));
  }
};

/// Dark below, of all colours above.
Sky uneven_sky() {
  Sky sky;
  sky.width = 5, sky.height = 4, sky.rotation = 0.7;
  sky.texels.assign(20, glm::vec3(0));
  for (int i = 0; i < 12; ++i) sky.texels[i] = glm::vec3(i % 4, i % 3, 0.3f * static_cast<float>(i));
  return sky;
}
constexpr float kSkyScale = 0.5f;

CheckResult check_one(Session& session, const Case& c) {
  std::mt19937 random(3);
  const std::unique_ptr<Basis> basis = make_basis(c.basis);
  const Transport transport = make_transport(TransportKind::sweep, *basis, {}, c.blocked_by);
  const float cell = static_cast<float>(kEdge / c.grid);
  const std::vector<ClpvGrid> grids =
      cascade_grids(cell * glm::vec3(0.5f, 1.5f, 2.5f), static_cast<int>(c.parts.size()), kEdge, c.grid);
  Sweeper sweeper(
      session, *basis, transport,
      {.grid = c.grid, .parts = c.parts, .blocking = c.blocking, .format = c.format, .form = c.form});
  const Sky sky = uneven_sky();
  if (c.sky) {
    sweeper.let_in(sky);
    sweeper.scale_sky(kSkyScale);
  }
  const VolumeShape injected{c.grid, basis->size(), 3}, swept{c.grid, swept_basis()->size(), 3},
      corners{c.grid + 1, blocking_size(c.blocked_by, *basis), 1};
  std::vector<Volume> lights, blockers;
  std::vector<std::vector<float>> found(grids.size());
  lights.reserve(grids.size()), blockers.reserve(grids.size());
  std::vector<SweptCascade> cascades(grids.size());
  for (std::size_t i = grids.size(); i-- > 0;) {
    lights.push_back(random_light(*basis, c.grid, random));
    blockers.push_back(random_blockers(corners.coefficients, c.grid, random));
    cascades[i] = {grids[i], &lights.back(), c.blocking ? &blockers.back() : nullptr, c.parts[i]};
    clpv::Volume light(session, injected, "check: light", c.format),
        result(session, swept, "check: swept", c.format),
        geometry(session, corners, "check: blockers", c.format);
    light.write(session, {lights.back().values.begin(), lights.back().values.end()});
    geometry.write(session, {blockers.back().values.begin(), blockers.back().values.end()});
    if (c.blocking) sweeper.block(i, geometry);
    sweeper.sweep(i, grids, light, result);
    found[i] = result.read(session);
  }
  CheckResult result{"sweep", c.name(), 0, tolerance_in("sweep", c.format), {}};
  Sky shining = sky;
  for (glm::vec3& texel : shining.texels) texel *= kSkyScale;
  const std::vector<Volume> twin = sweep(*basis, transport, cascades, c.sky ? &shining : nullptr);
  for (std::size_t i = 0; i < grids.size(); ++i) compare_cascade(found[i], kept_of(twin[i]), i, result);
  return result;
}

}  // namespace

CheckResults check_sweep(Session& session, const CheckScope& scope) {
  std::vector<Case> cases = {
      {.basis = "bins24", .grid = 9, .parts = {2, 1, 1}},
      {.basis = "bins24", .grid = 8, .parts = {2, 2}, .form = SweepForm::planes},
      {.basis = "bins24", .grid = 7, .parts = {1, 1, 2}, .form = SweepForm::planes},
      {.basis = "bins24", .grid = 9, .parts = {2, 1, 2}, .sky = true},
      {.basis = "bins24", .grid = 7, .parts = {1, 3}, .form = SweepForm::planes, .sky = true},
      {.basis = "sh2", .grid = 9, .parts = {1, 1}, .blocked_by = Blocking::one_sided},
      {.basis = "bins96", .grid = 5, .parts = {3, 2}, .blocking = false},
      {.basis = "srbf8v2", .grid = 1, .parts = {1, 1, 1}},
  };
  for (const VolumeFormat& format : other_formats(session.device(), {9, kSweepBins, 3}, scope.formats))
    cases.push_back({.basis = "bins24", .grid = 9, .parts = {1, 1}, .format = format});
  if (scope.thorough) {
    for (const std::string& name : basis_names()) {
      for (const int parts : {1, 2, 3, 4}) cases.push_back({.basis = name, .grid = 6, .parts = {parts, 1}});
    }
  }
  CheckResults results;
  for (const Case& c : cases) results.push_back(check_one(session, c));
  return results;
}

}  // namespace clpv::reference
