// SPDX-License-Identifier: MIT
// Light that surfaces send back: sweeps with more bounces, kernels against the twin, on small cascades of random light, random
// blockers and random reflectors.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "basis/bounce.hpp"
#include "basis/sweep.hpp"
#include "checks/check.hpp"
#include "checks/check_inputs.hpp"
#include "checks/tolerances.hpp"
#include "pipeline/cascade.hpp"
#include "pipeline/sweep.hpp"
#include "reference/bounce.hpp"

namespace clpv::reference {
namespace {

constexpr double kEdge = 4;  // of the finest grid [m]

struct Case {
  std::string basis;
  int grid;
  std::vector<int> parts;
  Bounces bounces;
  VolumeFormat format = {};
  SweepForm form = SweepForm::bins;

  std::string name() const {
    return fmt::format("{}/{}^3/{} cascades/{} bounces{}/{}", basis, grid, parts.size(), name_of(bounces),
                       form == SweepForm::planes ? "/planes" : "", format_name(format));
  }
};

/// A third of the sides reflect.
Volume random_reflectors(int n, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-2, 1);
  Volume volume(n, kReflectingSides);
  for (double& value : volume.values) value = std::max(0.0f, uniform(random));
  return volume;
}

/// What a cascade is given, on both sides; the device's volumes hold the same numbers.
struct Given {
  Volume light, blockers, reflectors;
};

clpv::Volume on_device(Session& session, const Volume& from, const VolumeFormat& format) {
  clpv::Volume volume(session, {from.n, from.coefficients, from.channels}, "check: bounces", format);
  volume.write(session, {from.values.begin(), from.values.end()});
  return volume;
}

CheckResult check_one(Session& session, const Case& c) {
  std::mt19937 random(5);
  const std::unique_ptr<Basis> basis = make_basis(c.basis);
  const Transport transport = make_transport(TransportKind::sweep, *basis, {}, Blocking::areas);
  const float cell = static_cast<float>(kEdge / c.grid);
  const std::vector<ClpvGrid> grids =
      cascade_grids(cell * glm::vec3(0.5f, 1.5f, 2.5f), static_cast<int>(c.parts.size()), kEdge, c.grid);
  Sweeper sweeper(
      session, *basis, transport,
      {.grid = c.grid, .parts = c.parts, .bounces = c.bounces, .format = c.format, .form = c.form});
  std::vector<Given> given;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    given.push_back({random_light(*basis, c.grid, random), random_blockers(3, c.grid, random),
                     random_reflectors(c.grid, random)});
  }
  std::vector<std::vector<float>> found(grids.size());
  std::vector<SweptCascade> cascades(grids.size());
  std::vector<const Volume*> reflecting;
  for (std::size_t i = grids.size(); i-- > 0;) {
    cascades[i] = {grids[i], &given[i].light, &given[i].blockers, c.parts[i]};
    const clpv::Volume light = on_device(session, given[i].light, c.format),
                       geometry = on_device(session, given[i].blockers, c.format),
                       reflectors = on_device(session, given[i].reflectors, c.format);
    clpv::Volume result(session, {c.grid, swept_basis()->size(), 3}, "check: bounced", c.format);
    sweeper.block(i, geometry);
    sweeper.reflect(i, reflectors);
    sweeper.sweep(i, grids, light, result);
    found[i] = result.read(session);
  }
  for (const Given& of : given) reflecting.push_back(&of.reflectors);
  CheckResult result{"bounce", c.name(), 0, tolerance_in("bounce", c.format), {}};
  const std::vector<Volume> twin = sweep_bounced(*basis, transport, cascades, reflecting, c.bounces);
  for (std::size_t i = 0; i < grids.size(); ++i) compare_cascade(found[i], kept_of(twin[i]), i, result);
  return result;
}

}  // namespace

CheckResults check_bounce(Session& session, const CheckScope& scope) {
  std::vector<Case> cases = {
      {.basis = "bins24", .grid = 9, .parts = {2, 1}, .bounces = Bounces::all},
      {.basis = "bins24", .grid = 8, .parts = {2, 2}, .bounces = Bounces::two, .form = SweepForm::planes},
      {.basis = "sh2", .grid = 7, .parts = {1, 2, 1}, .bounces = Bounces::all, .form = SweepForm::planes},
      {.basis = "srbf8v2", .grid = 1, .parts = {1}, .bounces = Bounces::all},
  };
  for (const VolumeFormat& format : other_formats(session.device(), {9, kSweepBins, 3}, scope.formats))
    cases.push_back(
        {.basis = "bins24", .grid = 9, .parts = {1, 1}, .bounces = Bounces::all, .format = format});
  if (scope.thorough) {
    for (const std::string& name : basis_names())
      cases.push_back({.basis = name, .grid = 6, .parts = {2, 1}, .bounces = Bounces::all});
  }
  CheckResults results;
  for (const Case& c : cases) results.push_back(check_one(session, c));
  return results;
}

}  // namespace clpv::reference
