// SPDX-License-Identifier: MIT
// Injection: kernels against CPU reference. Checks use small random surfaces.

#include "pipeline/inject/inject.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <span>

#include "pipeline/inject/emit.hpp"
#include "pipeline/raster/view.hpp"
#include "reference/inject.hpp"
#include "reference/view.hpp"
#include "verify/check.hpp"
#include "verify/inputs.hpp"
#include "verify/jobs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::verify {

namespace {

constexpr int kInjectGrid =
    5;  // odd and small: many texels per cell, several segments in some cells
constexpr unsigned kWidth = 61, kHeight = 47;  // no multiples of a work-group
// [cells]; excludes points close to a cell boundary, where rounding decides. Exceeds the position
// error of 8-bit normals.
constexpr double kMargin = 0.01;

const ClpvGrid kCells = {{-1.5f, 0.5f, 2.0f}, 0.5f, kInjectGrid, {}};

/// A view from above or from a corner that shows the grid and some space beside it.
ClpvView view_of_grid(bool orthographic, float distance) {
  const glm::vec3 centre = glm::vec3(vector(kCells.origin)) + 0.5f * kCells.cell * kInjectGrid;
  SceneCamera camera;
  camera.forward =
      glm::normalize(orthographic ? glm::vec3(0.2f, -1, 0.1f) : glm::vec3(-1, -0.7f, 0.5f));
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

/// Leaves out texels whose cell in sight rounding may decide.
void leave_out_unsure(const std::vector<std::uint8_t>& occluded, const InjectOptions& options,
                      SurfaceImage& surface) {
  const std::uint8_t* bits = occluded.data() + occluded.size() / 2;
  for (std::size_t i = 0; i < surface.depth.size(); ++i) {
    const glm::dvec3 at = reference::light_point(surface, i, kCells, options.in_front);
    const auto cell = reference::nearest_in_sight(at, kInjectGrid, bits);
    for (int o = 0; o < 8; ++o) {
      const glm::dvec3 off = kMargin * (2.0 * glm::dvec3(o & 1, o >> 1 & 1, o >> 2) - 1.0);
      if (reference::nearest_in_sight(at + off, kInjectGrid, bits) != cell) surface.depth[i] = 0;
    }
  }
}

/// Random depths, colours and normals towards the viewer, with holes and values that are not
/// finite. Excludes normals whose lobe depends on rounding.
SurfaceImage random_surface(const Basis& basis, const InjectOptions& options, bool orthographic,
                            bool light, RsmFormat format, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  constexpr float kFar = 5;  // [m]; most texels are near this depth, many of them in a cell
  SurfaceImage surface;
  surface.view = view_of_grid(orthographic, kFar);
  const glm::vec3 forward(vector(surface.view.forward));
  const std::size_t count = std::size_t{kWidth} * kHeight;
  surface.normal.resize(count), surface.colour.resize(count), surface.depth.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 around(uniform(random), uniform(random), uniform(random));
    surface.depth[i] = uniform(random) > 0.8f ? 0 : kFar + std::pow(1.1f * uniform(random), 5.0f);
    surface.normal[i] = glm::vec4(glm::normalize(1.2f * around - forward), 0);
    surface.colour[i] =
        0.5f + 0.5f * glm::vec4(uniform(random), uniform(random), uniform(random), 0);
    const glm::dvec3 point = light ? reference::light_point(surface, i, kCells, options.in_front)
                                   : reference::grid_point(surface, i, kCells) + 0.5;
    const bool unsure = options.lobes.kind == LobeKind::rotate &&
                        rounding_decides(basis, options.lobes, glm::dvec3(surface.normal[i]));
    if (unsure || near_border(point)) surface.depth[i] = 0;
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
    const glm::dvec3 at =
        reference::surface_position(surface.view, static_cast<double>(i % kWidth),
                                    static_cast<double>(i / kWidth), surface.depth[i]);
    surface.position.emplace_back(glm::vec3(at), 1);
    if (surface.depth[i] == 0) surface.normal[i] = glm::vec4(0);
  }
  surface.depth.clear();
  return surface;
}

/// Volumes and kernels of one injection.
struct InjectWork {
  InjectProblem problem;
  std::optional<Volume> light, geometry;
  Buffer occluded;
  Injector injector;

  InjectWork(Session& session, const InjectProblem& p)
      : problem(p), injector(session, *p.basis, problem.options) {
    const InjectOptions& o = p.options;
    if (p.light)
      light.emplace(session, VolumeShape{o.grid, p.basis->size(), 3}, "injected light", o.format);
    if (!p.blockers.empty())
      geometry.emplace(session, VolumeShape{o.grid + 1, blocking_size(o.blocking, *p.basis), 1},
                       "geometry volume", o.format);
    if (!p.occluded.empty()) occluded = session.upload(p.occluded, "occluded cells");
  }

  void clear(Session& session) {
    if (light) light->clear(session);
    if (geometry) geometry->clear(session);
  }
  void run() {
    if (light) injector.inject_light({{problem.light->surface, problem.grid, *light, 1}}, occluded);
    for (const InjectedSurface& blocker : problem.blockers)
      injector.inject_geometry(blocker.surface, problem.grid, *geometry, problem.stride);
  }
};

/// Expected volumes: light (if injected), then geometry (if injected) and the alternative geometry
/// that is equally correct where rounding decides between two surfaces.
std::vector<double> expected_volumes(const InjectProblem& p) {
  const InjectOptions& o = p.options;
  std::vector<double> values;
  if (p.light) {
    reference::Volume light(o.grid, p.basis->size(), 3);
    reference::inject_light(
        *p.light->image, p.grid, *p.basis, o,
        p.occluded.empty() ? nullptr : p.occluded.data() + p.occluded.size() / 2, light);
    values = std::move(light.values);
  }
  if (p.blockers.empty()) return values;
  reference::Volume merged(o.grid + 1, blocking_size(o.blocking, *p.basis), 1),
      alternative = merged;
  const reference::Volume none = merged;
  for (const InjectedSurface& blocker : p.blockers) {
    reference::Volume found = none;
    reference::inject_geometry(*blocker.image, p.grid, *p.basis, o, found, p.stride);
    alternative = reference::merged_against_ties(merged, found, *p.basis, o.blocking);
    reference::merge_geometry(found, *p.basis, o.blocking, merged);
  }
  values.insert(values.end(), merged.values.begin(), merged.values.end());
  values.insert(values.end(), alternative.values.begin(), alternative.values.end());
  return values;
}

/// The larger deviation of both volumes.
Deviation compare(Session& session, const InjectWork& p, const std::vector<double>& expected) {
  const Basis& basis = *p.problem.basis;
  const InjectOptions& o = p.problem.options;
  const bool exact = o.lobes.kind == LobeKind::exact, half = o.format.storage == Storage::float16;
  const char* stage = !exact && p.problem.on_entries ? "inject-on-entries"
                      : exact || half                ? "inject"
                                                     : "inject-rotated";
  Deviation result{0, tolerance(stage, o.format.storage)};
  const auto take = [&](const Volume& volume, bool light) {
    const std::vector<float> values = volume.read(session);
    const std::size_t size = values.size();
    const std::span<const double> all(expected);
    const auto merged = light ? all.first(size) : all.last(2 * size).first(size);
    const auto weights = [&](const glm::dvec3& w) {
      return light ? basis.evaluate(w) : blocking_weights(o.blocking, basis, o.lobes, w);
    };
    const VolumeShape& shape = volume.shape();
    const auto other = light ? merged : all.last(size);
    expect_functions(session, volume, merged, other, weights, result.allowed);
    const Deviation found =
        compare_functions(values, merged, other, shape.n, shape.coefficients, weights);
    result.take(found.worst,
                [&] { return fmt::format("{}, {}", light ? "light" : "geometry", found.place); });
  };
  if (p.light) take(*p.light, true);
  if (p.geometry) take(*p.geometry, false);
  return result;
}

/// One case of injected light, or of geometry with blockers.
struct InjectCase {
  InjectOptions options = {};
  bool light = true, orthographic = true, points = false, sees = false;
  RsmFormat format = RsmFormat::float32;
  int stride = 1;

  std::string name(const std::string& basis) const {
    std::string name = fmt::format("{}/{}/{}", basis,
                                   points  ? "points"
                                   : light ? "light"
                                           : "geometry",
                                   orthographic ? "orthographic" : "perspective");
    if (format == RsmFormat::paper) name += "/paper";
    if (options.blocking == Blocking::areas) name += "/areas";
    if (options.unit_flux_lobes) name += "/unit-flux";
    if (options.lobes.kind == LobeKind::rotate) name += "/rotate";
    if (options.table == TableStorage::image) name += "/image";
    if (sees) name += "/visible";
    if (options.format != VolumeFormat{}) name += fmt::format("/{}", format_name(options.format));
    return stride == 1 ? name : name + fmt::format("/stride {}", stride);
  }
};

/// Returns the cases of one basis. Light and blockers evaluate the same lobes, so without
/// `thorough` only the small bases compare both. Features nearly independent of the basis use them
/// too.
std::vector<InjectCase> cases_of_basis(const Basis& basis, bool thorough) {
  const bool both = thorough || basis.size() == 4;
  std::vector<InjectCase> cases = {{}};
  if (both) cases.push_back({.light = false});
  if (!basis.centres().empty()) {  // rotated lobes of other bases are exact
    const InjectOptions rotated{.lobes = {.kind = LobeKind::rotate}};
    cases.push_back({.options = rotated});
    if (both) {
      cases.push_back({.options = rotated, .light = false});
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
  cases.push_back(
      {.options = {.in_front = false}, .orthographic = false, .format = RsmFormat::paper});
  cases.push_back({.light = false, .orthographic = false, .format = RsmFormat::paper});
  return cases;
}

}  // namespace

InjectedSurface upload_injected(Session& session, const SurfaceImage& image, RsmFormat format,
                                float colour_scale) {
  const Surface surface = upload_surface(session, image, format, colour_scale);
  return {surface, std::make_shared<const SurfaceImage>(read_surface(session, surface))};
}

Job inject_job(Session& session, const InjectProblem& problem, const Share& share) {
  const auto p = std::make_shared<InjectWork>(session, problem);
  Job job;
  job.reset = [p, &session] { p->clear(session); };
  job.run = [p] { p->run(); };
  job.compare = [p, &session, share] {
    return compare(session, *p, *share([&] { return expected_volumes(p->problem); }));
  };
  return job;
}

InjectProblem random_injection(Session& session, const std::shared_ptr<const Basis>& basis,
                               const InjectOptions& options, bool light, bool orthographic,
                               RsmFormat format, bool points, bool sees) {
  InjectProblem problem{basis, options, kCells, {}, {}};
  problem.options.grid = kInjectGrid;
  if (sees) {
    std::mt19937 random(14);
    problem.occluded = random_occlusion(2, kInjectGrid, random);
    for (std::uint8_t& bits : problem.occluded) bits &= random();  // 1 of 3 cells is in sight
    for (std::uint8_t& bits : problem.occluded) bits &= random();
  }
  const auto surface = [&](bool above, unsigned seed) {
    SurfaceImage image = random_surface(*basis, options, above, light, format, seed);
    if (sees) leave_out_unsure(problem.occluded, problem.options, image);
    if (points) image = as_points(std::move(image));
    return upload_injected(session, image, format);
  };
  if (light)
    problem.light = surface(orthographic, 11);
  else
    problem.blockers = {surface(orthographic, 12), surface(!orthographic, 13)};
  return problem;
}

Cases inject_cases(const CheckScope& scope) {
  Cases cases;
  const auto add = [&](const std::string& basis, const InjectCase& c) {
    cases.push_back(job_case(Stage::inject, c.name(basis), [basis, c](Session& session) {
      InjectProblem problem = random_injection(session, make_basis(basis), c.options, c.light,
                                               c.orthographic, c.format, c.points, c.sees);
      problem.stride = c.stride;
      return inject_job(session, problem);
    }));
  };
  for (const std::string& name : scope.bases)
    for (const InjectCase& c : cases_of_basis(*make_basis(name), scope.thorough)) add(name, c);
  // Independent of the basis: areas, points without a view, and all other volume formats.
  const InjectOptions areas{.blocking = Blocking::areas};
  add("sh2", {.options = areas, .light = false});
  for (const bool sees : {false, true})
    add("sh2", {.orthographic = false, .points = true, .sees = sees});
  add("sh2", {.sees = true});
  for (const int stride : {1, 2, 3})
    add("sh2", {.options = areas, .light = false, .orthographic = false, .stride = stride});
  for (const VolumeFormat& format : scope.formats) {
    add("sh2", {.options = {.format = format}, .orthographic = false});
    if (scope.thorough) add("sh2", {.options = {.format = format}, .light = false});
  }
  return cases;
}

// Points of emissive triangles: kernel against CPU reference on random triangles of all sizes,
// textured and masked.

namespace {

constexpr unsigned kEmitGrid = 4;
constexpr float kScale = 0.25f;

/// Emission of the triangles: a texture, the same texture masked, and a double-sided colour.
SceneData emissive_soup() {
  SceneData scene = triangle_soup();
  for (ClpvMaterial& material : scene.materials) {
    material.emissive[0] = 3, material.emissive[1] = 2, material.emissive[2] = 0.5f;
    material.emissive_texture = 0;
  }
  ClpvMaterial plain = scene.materials[0];
  plain.texture = plain.emissive_texture = CLPV_NO_TEXTURE;
  plain.flags = CLPV_MATERIAL_DOUBLE_SIDED;
  scene.materials.push_back(plain);
  for (std::size_t i = 0; i < scene.triangles.size(); i += 4) scene.triangles[i].material = 2;
  return scene;
}

/// Sums of squares are at most what compare_scene() allows where each number is.
void expect_points(Session& session, const Surface& points,
                   const std::vector<reference::EmittedPoint>& expected, double largest) {
  const double allowed = tolerance("emit");
  Ranges places, normals, fluxes;
  const auto append = [](Ranges& ranges, const glm::dvec3& value, double error) {
    for (int k = 0; k < 3; ++k) ranges.push_back({value[k] - error, value[k] + error});
    ranges.push_back({});
  };
  for (const reference::EmittedPoint& point : expected) {
    append(places, point.position, 10 * allowed);
    append(normals, point.normal, allowed);
    append(fluxes, double{kScale} * point.flux,
           double{kScale} * (2 * point.tolerance + allowed * largest));
  }
  expect(session, points.position, "float", places);
  expect(session, points.normal, "float", normals);
  expect(session, points.colour, "float", fluxes);
}

Deviation compare_scene(Session& session, const SceneData& scene) {
  const std::vector<ClpvGrid> grids = {{{-1, 2, 2.5f}, 0.5f, kEmitGrid, {}},
                                       {{-2, 1, 1.5f}, 1, kEmitGrid, {}}};
  const EmissionPlan plan = plan_emission(scene, emissive_triangles(scene), grids);
  const SceneBuffers buffers = upload_scene(session, scene);
  Emitter emitter(session, buffers);
  emitter.emit(plan, kScale);
  const SurfaceImage found = read_surface(session, emitter.points());
  const std::vector<reference::EmittedPoint> expected = reference::emit(scene, plan);
  double largest = 0;
  for (const reference::EmittedPoint& point : expected)
    largest = std::max({largest, point.flux.x, point.flux.y, point.flux.z});
  Deviation result{0, tolerance("emit")};
  expect_points(session, emitter.points(), expected, largest);
  for (std::size_t i = 0; i < found.normal.size(); ++i) {
    const reference::EmittedPoint wanted =
        i < expected.size() ? expected[i] : reference::EmittedPoint{};
    const glm::dvec3 flux = glm::dvec3(found.colour[i]) / double{kScale};
    const double off = glm::length(flux - wanted.flux) - 2 * wanted.tolerance;
    const double places = glm::length(glm::dvec3(found.position[i]) - wanted.position) / 10 +
                          glm::length(glm::dvec3(found.normal[i]) - wanted.normal);
    const auto where = [&] {
      return fmt::format(
          "point {} of {}: flux {:.6g} {:.6g} {:.6g}, expected {:.6g} {:.6g} {:.6g}; off by {:.2g}",
          i, expected.size(), flux.x, flux.y, flux.z, wanted.flux.x, wanted.flux.y, wanted.flux.z,
          places);
    };
    result.take(off / largest, where);
    result.take(places, where);
  }
  return result;
}

SceneData plain_soup() {
  SceneData scene = emissive_soup();
  for (ClpvMaterial& material : scene.materials) {
    material.flags = 0;
    material.texture = material.emissive_texture = CLPV_NO_TEXTURE;
  }
  return scene;
}

}  // namespace

Cases emit_cases(const CheckScope&) {
  return {deviation_case(Stage::emit, "textures and holes",
                         [](Session& session) { return compare_scene(session, emissive_soup()); }),
          deviation_case(Stage::emit, "plain",
                         [](Session& session) { return compare_scene(session, plain_soup()); })};
}

}  // namespace clpv::verify
