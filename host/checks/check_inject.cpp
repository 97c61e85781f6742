// SPDX-License-Identifier: MIT
// Injection: kernels against the twin on small random surfaces.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "checks/check.hpp"
#include "checks/check_inputs.hpp"
#include "checks/comparison.hpp"
#include "checks/tolerances.hpp"
#include "pipeline/inject.hpp"
#include "reference/inject.hpp"
#include "reference/view.hpp"

namespace clpv::reference {
namespace {

constexpr int kGrid = 5;                       // odd, small: many texels a cell, several segments in some
constexpr unsigned kWidth = 37, kHeight = 23;  // no multiple of anything
// [cells]; points nearer to where the cell changes are left out, since there rounding decides. More than what
// 8-bit normals can move a point.
constexpr double kMargin = 0.01;

const ClpvGrid kCells = {{-1.5f, 0.5f, 2.0f}, 0.5f, kGrid, {}};

/// A view from above or from a corner that sees the grid and some space beside it.
ClpvView view_of_grid(bool orthographic, double distance) {
  const glm::vec3 centre = glm::vec3(kCells.origin[0], kCells.origin[1], kCells.origin[2]) +
                           0.5f * kCells.cell * static_cast<float>(kGrid);
  const glm::vec3 forward =
      glm::normalize(orthographic ? glm::vec3(0.2f, -1, 0.1f) : glm::vec3(-1, -0.7f, 0.5f));
  const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 0, 1)));
  const glm::vec3 up = glm::cross(right, forward), eye = centre - static_cast<float>(distance) * forward;
  ClpvView view{};
  for (int a = 0; a < 3; ++a) {
    view.eye[a] = eye[a], view.right[a] = right[a], view.up[a] = up[a], view.forward[a] = forward[a];
  }
  view.orthographic = orthographic ? 1.0f : 0.0f;
  view.half_width = orthographic ? 1.6f : 0.4f;
  view.half_height = orthographic ? 1.5f : 0.35f;
  view.width = kWidth, view.height = kHeight;
  view.far_depth = 100;
  return view;
}

bool near_border(const glm::dvec3& point) {
  const glm::dvec3 within = point - glm::floor(point), off = glm::min(within, 1.0 - within);
  return std::min({off.x, off.y, off.z}) < kMargin;
}

/// Random depths, normals towards the viewer and colours; holes and values that are not finite among them. No normal
/// whose lobe rounding decides.
SurfaceImage random_surface(const Basis& basis, const LobeOptions& lobes, bool orthographic, bool light,
                            RsmFormat format, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  constexpr float kDistance = 5, kSpread = 1.4f;
  SurfaceImage surface;
  surface.view = view_of_grid(orthographic, kDistance);
  const glm::vec3 forward(surface.view.forward[0], surface.view.forward[1], surface.view.forward[2]);
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

/// The same as points that no view sees.
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

/// 26 directions: towards the neighbours of a cell in a cube.
std::vector<glm::dvec3> directions() {
  std::vector<glm::dvec3> found;
  for (int i = 0; i < 27; ++i) {
    if (i != 13) found.push_back(glm::normalize(glm::dvec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)));
  }
  return found;
}

/// The functions, not their coefficients, are compared: where the Gram matrix is ill-conditioned coefficients
/// differ in directions in which functions hardly do.
CheckResult compare(const Basis& basis, const InjectOptions& options, const std::vector<float>& device,
                    const Volume& twin, const std::string& variant) {
  const bool rotated = options.lobes.kind == LobeKind::rotate;
  CheckResult result{"inject",
                     variant,
                     0,
                     rotated ? tolerance("inject-rotated") : tolerance_in("inject", options.format),
                     {}};
  const auto cells = static_cast<std::size_t>(twin.n) * twin.n * twin.n;
  const std::size_t size = twin.coefficients;
  const bool areas = twin.channels == 1 && !blocks_by_lobes(options.blocking);
  double largest = 0;
  WorstError worst;
  for (const glm::dvec3& w : directions()) {
    const std::vector<double> b =
        areas ? blocking_weights(options.blocking, basis, options.lobes, w) : basis.evaluate(w);
    for (std::size_t at = 0; at < cells * static_cast<std::size_t>(twin.channels); ++at) {
      const std::size_t channel = at / cells, cell = at % cells;
      double found = 0, wanted = 0;
      for (std::size_t i = 0; i < size; ++i) {
        found += b[i] * static_cast<double>(device[(channel * size + i) * cells + cell]);
        wanted += b[i] * twin.values[(channel * size + i) * cells + cell];
      }
      largest = std::max(largest, std::abs(wanted));
      if (!worst.take(std::abs(found - wanted), cell)) continue;
      const std::size_t n = twin.n;
      result.place = fmt::format("cell {},{},{} channel {} towards {:.2f},{:.2f},{:.2f}: {:.7g}, twin {:.7g}",
                                 cell % n, cell / n % n, cell / n / n, channel, w.x, w.y, w.z, found, wanted);
    }
  }
  result.worst = worst.value / largest;
  return result;
}

std::string blocking_label(Blocking blocking) {
  return blocking == InjectOptions{}.blocking ? "" : fmt::format("/{}", clpv::name_of(blocking));
}

std::string name_of(const Basis& basis, const char* stage, bool orthographic, RsmFormat format,
                    const InjectOptions& options) {
  return fmt::format("{}/{}/{}{}{}{}", basis.name(), stage, orthographic ? "orthographic" : "perspective",
                     format == RsmFormat::paper ? "/paper" : "", blocking_label(options.blocking),
                     options.unit_flux_lobes ? "/unit-flux" : "") +
         (options.lobes.kind == LobeKind::exact ? "" : "/rotate") +
         (options.table == TableStorage::buffer ? "" : "/image") +
         (options.format == VolumeFormat{} ? "" : fmt::format("/{}", format_name(options.format)));
}

CheckResult check_light(Session& session, const Basis& basis, const InjectOptions& options, bool orthographic,
                        RsmFormat format, bool points = false) {
  SurfaceImage image = random_surface(basis, options.lobes, orthographic, true, format, 11);
  if (points) image = as_points(std::move(image));
  const Surface surface = upload_surface(session, image, format);
  clpv::Volume light(session, {kGrid, basis.size(), 3}, "check: light", options.format);
  Injector(session, basis, options).inject_light(surface, kCells, light);
  Volume twin(kGrid, basis.size(), 3);
  inject_light(read_surface(session, surface), kCells, basis, options, twin);
  return compare(basis, options, light.read(session), twin,
                 name_of(basis, points ? "points" : "light", orthographic, format, options));
}

/// Two surfaces, so that they are merged.
CheckResult check_geometry(Session& session, const Basis& basis, const InjectOptions& options,
                           bool orthographic, RsmFormat format, int stride = 1) {
  const int numbers = blocking_size(options.blocking, basis);
  clpv::Volume geometry(session, {kGrid + 1, numbers, 1}, "check: geometry", options.format);
  Volume twin(kGrid + 1, numbers, 1);
  Injector injector(session, basis, options);
  for (const unsigned seed : {12u, 13u}) {
    const bool from_above = orthographic == (seed == 12u);
    const Surface surface = upload_surface(
        session, random_surface(basis, options.lobes, from_above, false, format, seed), format);
    injector.inject_geometry(surface, kCells, geometry, stride);
    inject_geometry(read_surface(session, surface), kCells, basis, options, twin, stride);
  }
  return compare(basis, options, geometry.read(session), twin,
                 name_of(basis, "geometry", orthographic, format, options) +
                     (stride == 1 ? "" : fmt::format("/stride {}", stride)));
}

/// Lobes rotated at run time. Reading an image hardly depends on the basis.
void check_rotated(Session& session, const Basis& basis, bool thorough, CheckResults& results) {
  if (basis.centres().empty()) return;  // rotated are the exact ones
  InjectOptions rotated{.grid = kGrid, .lobes = {.kind = LobeKind::rotate}};
  results.push_back(check_light(session, basis, rotated, true, RsmFormat::float32));
  results.push_back(check_geometry(session, basis, rotated, true, RsmFormat::float32));
  rotated.table = TableStorage::image;
  if (session.device().images && (thorough || basis.size() == 4))
    results.push_back(check_light(session, basis, rotated, false, RsmFormat::float32));
  if (!thorough) return;
  const InjectOptions scaled{.grid = kGrid, .unit_flux_lobes = true, .lobes = rotated.lobes};
  results.push_back(check_light(session, basis, scaled, false, RsmFormat::float32));
}

/// Every other way for volumes to lie in memory.
void check_formats(Session& session, const CheckScope& scope, CheckResults& results) {
  const std::unique_ptr<Basis> basis = make_basis("sh2");
  for (const VolumeFormat& format :
       other_formats(session.device(), {kGrid + 1, basis->size(), 3}, scope.formats)) {
    const InjectOptions options{.grid = kGrid, .format = format};
    results.push_back(check_light(session, *basis, options, false, RsmFormat::float32));
    results.push_back(check_geometry(session, *basis, options, true, RsmFormat::float32));
  }
}

}  // namespace

CheckResults check_inject(Session& session, const CheckScope& scope) {
  CheckResults results;
  for (const std::string& name : scope.bases) {
    const std::unique_ptr<Basis> basis = make_basis(name);
    const InjectOptions plain{.grid = kGrid};
    results.push_back(check_light(session, *basis, plain, true, RsmFormat::float32));
    results.push_back(check_geometry(session, *basis, plain, true, RsmFormat::float32));
    check_rotated(session, *basis, scope.thorough, results);
    // What hardly depends on the basis, for the small ones: compiling takes most of the time.
    if (basis->size() > 4) continue;
    const InjectOptions unit_flux{.grid = kGrid, .unit_flux_lobes = true};
    results.push_back(check_light(session, *basis, unit_flux, false, RsmFormat::float32));
    results.push_back(check_light(session, *basis, plain, false, RsmFormat::paper));
    results.push_back(check_geometry(session, *basis, plain, false, RsmFormat::paper));
  }
  for (const bool orthographic : {true, false}) {
    const InjectOptions areas{.grid = kGrid, .blocking = Blocking::areas};  // whatever the basis
    for (const int stride : {1, 2, 3}) {
      if (orthographic && stride > 1) continue;
      results.push_back(
          check_geometry(session, *make_basis("sh2"), areas, orthographic, RsmFormat::float32, stride));
    }
  }
  results.push_back(
      check_light(session, *make_basis("sh2"), {.grid = kGrid}, false, RsmFormat::float32, true));
  check_formats(session, scope, results);
  return results;
}

}  // namespace clpv::reference
