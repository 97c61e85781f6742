// SPDX-License-Identifier: MIT
// Injection: kernels against CPU reference on small random surfaces.
#include "pipeline/inject/inject.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "pipeline/raster/view.hpp"
#include "reference/inject.hpp"
#include "reference/view.hpp"
#include "verify/check.hpp"
#include "verify/comparison.hpp"
#include "verify/inputs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::reference {
namespace {

constexpr int kGrid = 5;  // odd and small: many texels per cell, several segments in some cells
constexpr unsigned kWidth = 37, kHeight = 23;  // no multiples of a work-group
// [cells]; excludes points close to a cell boundary, where rounding decides. Exceeds the position error of 8-bit
// normals.
constexpr double kMargin = 0.01;

const ClpvGrid kCells = {{-1.5f, 0.5f, 2.0f}, 0.5f, kGrid, {}};

/// A view from above or from a corner that shows the grid and some space beside it.
ClpvView view_of_grid(bool orthographic, float distance) {
  const glm::vec3 centre = glm::vec3(vector(kCells.origin)) + 0.5f * kCells.cell * kGrid;
  SceneCamera camera;
  camera.forward = glm::normalize(orthographic ? glm::vec3(0.2f, -1, 0.1f) : glm::vec3(-1, -0.7f, 0.5f));
  camera.up = {0, 0, 1};
  camera.eye = centre - distance * camera.forward;
  ClpvView view = camera_view(camera, kWidth, kHeight);
  view.orthographic = orthographic ? 1.0f : 0.0f;
  view.half_width = orthographic ? 1.6f : 0.4f;
  view.half_height = orthographic ? 1.5f : 0.35f;
  return view;
}

bool near_border(const glm::dvec3& point) {
  const glm::dvec3 within = point - glm::floor(point), off = glm::min(within, 1.0 - within);
  return std::min({off.x, off.y, off.z}) < kMargin;
}

/// Random depths, colours and normals towards the viewer, with holes and values that are not finite. Excludes normals
/// whose lobe depends on rounding.
SurfaceImage random_surface(const Basis& basis, const LobeOptions& lobes, bool orthographic, bool light,
                            RsmFormat format, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  constexpr float kDistance = 5, kSpread = 1.4f;
  SurfaceImage surface;
  surface.view = view_of_grid(orthographic, kDistance);
  const glm::vec3 forward(vector(surface.view.forward));
  const std::size_t count = std::size_t{kWidth} * kHeight;
  surface.normal.resize(count), surface.colour.resize(count), surface.depth.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 around(uniform(random), uniform(random), uniform(random));
    surface.depth[i] = uniform(random) > 0.8f ? 0 : kDistance + kSpread * uniform(random);
    surface.normal[i] = glm::vec4(glm::normalize(1.2f * around - forward), 0);
    surface.colour[i] = 0.5f + 0.5f * glm::vec4(uniform(random), uniform(random), uniform(random), 0);
    const glm::dvec3 point = grid_point(surface, i, kCells, light);
    const bool unsure =
        lobes.kind == LobeKind::rotate && rounding_decides(basis, lobes, glm::dvec3(surface.normal[i]));
    if (unsure || near_border(light ? point : point + 0.5)) surface.depth[i] = 0;
  }
  surface.depth[3] = std::numeric_limits<float>::infinity();
  if (format == RsmFormat::paper) return surface;  // 8 bits hold no NaN
  surface.normal[5].y = std::numeric_limits<float>::quiet_NaN();
  if (light) surface.colour[7].x = std::numeric_limits<float>::quiet_NaN();
  return surface;
}

/// The same surface as points without a view.
SurfaceImage as_points(SurfaceImage surface) {
  for (std::size_t i = 0; i < surface.depth.size(); ++i) {
    const glm::dvec3 at = surface_position(surface.view, static_cast<double>(i % kWidth),
                                           static_cast<double>(i / kWidth), surface.depth[i]);
    surface.position.emplace_back(glm::vec3(at), 1);
    if (surface.depth[i] == 0) surface.normal[i] = glm::vec4(0);
  }
  surface.depth.clear();
  return surface;
}

/// One comparison of injected light, or of geometry with blockers.
struct InjectCase {
  InjectOptions options = {};
  bool light = true, orthographic = true, points = false;
  RsmFormat format = RsmFormat::float32;
  int stride = 1;

  std::string name(const Basis& basis) const {
    std::string name = fmt::format("{}/{}/{}", basis.name(),
                                   points  ? "points"
                                   : light ? "light"
                                           : "geometry",
                                   orthographic ? "orthographic" : "perspective");
    if (format == RsmFormat::paper) name += "/paper";
    if (options.blocking == Blocking::areas) name += "/areas";
    if (options.unit_flux_lobes) name += "/unit-flux";
    if (options.lobes.kind == LobeKind::rotate) name += "/rotate";
    if (options.table == TableStorage::image) name += "/image";
    if (options.format != VolumeFormat{}) name += fmt::format("/{}", format_name(options.format));
    return stride == 1 ? name : name + fmt::format("/stride {}", stride);
  }
};

/// Blockers come from two surfaces, to test merging.
CheckResult check_one(Session& session, const Basis& basis, InjectCase c) {
  c.options.grid = kGrid;
  const InjectOptions& options = c.options;
  const int samples = kGrid + (c.light ? 0 : 1),
            numbers = c.light ? basis.size() : blocking_size(options.blocking, basis),
            channels = c.light ? 3 : 1;
  clpv::Volume volume(session, {samples, numbers, channels}, "check: injection", options.format);
  Volume expected(samples, numbers, channels);
  Injector injector(session, basis, options);
  if (c.light) {
    SurfaceImage image = random_surface(basis, options.lobes, c.orthographic, true, c.format, 11);
    if (c.points) image = as_points(std::move(image));
    const Surface surface = upload_surface(session, image, c.format);
    injector.inject_light(surface, kCells, volume);
    inject_light(read_surface(session, surface), kCells, basis, options, expected);
  }
  for (unsigned seed = 12; seed < 14 && !c.light; ++seed) {
    const bool from_above = c.orthographic == (seed == 12);
    const SurfaceImage image = random_surface(basis, options.lobes, from_above, false, c.format, seed);
    const Surface surface = upload_surface(session, image, c.format);
    injector.inject_geometry(surface, kCells, volume, c.stride);
    inject_geometry(read_surface(session, surface), kCells, basis, options, expected, c.stride);
  }
  const auto weights = [&](const glm::dvec3& w) {
    return c.light ? basis.evaluate(w) : blocking_weights(options.blocking, basis, options.lobes, w);
  };
  const Comparison apart =
      compare_functions(volume.read(session), expected.values, expected.values, samples, numbers, weights);
  const bool rotated = options.lobes.kind == LobeKind::rotate;
  const double allowed = rotated ? tolerance("inject-rotated") : tolerance("inject", options.format.storage);
  return {"inject", c.name(basis), apart.worst, allowed, apart.place};
}

/// Returns the comparisons of one basis. Light and blockers evaluate the same lobes, so without `thorough` only the small
/// bases compare both. Features nearly independent of the basis use them too.
std::vector<InjectCase> cases_of(const Device& device, const Basis& basis, bool thorough) {
  const bool both = thorough || basis.size() == 4;
  std::vector<InjectCase> cases = {{}};
  if (both) cases.push_back({.light = false});
  if (!basis.centres().empty()) {  // rotated lobes of other bases are exact
    const InjectOptions rotated{.lobes = {.kind = LobeKind::rotate}};
    cases.push_back({.options = rotated});
    if (both) cases.push_back({.options = rotated, .light = false});
    if (device.images && both) {
      cases.push_back({.options = rotated, .orthographic = false});
      cases.back().options.table = TableStorage::image;
    }
    if (thorough) {
      cases.push_back({.options = rotated, .orthographic = false});
      cases.back().options.unit_flux_lobes = true;
    }
  }
  if (basis.size() > 4 || (!thorough && !basis.centres().empty())) return cases;
  cases.push_back({.options = {.unit_flux_lobes = true}, .orthographic = false});
  cases.push_back({.orthographic = false, .format = RsmFormat::paper});
  cases.push_back({.light = false, .orthographic = false, .format = RsmFormat::paper});
  return cases;
}

}  // namespace

CheckResults check_inject(Session& session, const CheckScope& scope) {
  CheckResults results;
  const auto add = [&](const Basis& basis, const InjectCase& c) {
    compare_selected(scope, "inject", c.name(basis), results, [&] { return check_one(session, basis, c); });
  };
  for (const std::string& name : scope.bases) {
    const std::unique_ptr<Basis> basis = make_basis(name);
    for (const InjectCase& c : cases_of(session.device(), *basis, scope.thorough)) add(*basis, c);
  }
  // Independent of the basis: areas, points without a view, and all other volume formats.
  const InjectOptions areas{.blocking = Blocking::areas};
  std::vector<InjectCase> cases = {{.options = areas, .light = false},
                                   {.orthographic = false, .points = true}};
  for (const int stride : {1, 2, 3})
    cases.push_back({.options = areas, .light = false, .orthographic = false, .stride = stride});
  const std::unique_ptr<Basis> basis = make_basis("sh2");
  for (const VolumeFormat& format :
       other_formats(session.device(), {kGrid + 1, basis->size(), 3}, scope.formats)) {
    cases.push_back({.options = {.format = format}, .orthographic = false});
    if (scope.thorough) cases.push_back({.options = {.format = format}, .light = false});
  }
  for (const InjectCase& c : cases) add(*basis, c);
  return results;
}

}  // namespace clpv::reference
