// SPDX-License-Identifier: MIT
// Points of emissive triangles: kernel against CPU reference on random triangles of all sizes,
// textured and masked.
#include "pipeline/inject/emit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/emit.hpp"
#include "verify/check.hpp"
#include "verify/inputs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::verify {
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
  session.recorder()->expect(points.position.handle(), "float", places);
  session.recorder()->expect(points.normal.handle(), "float", normals);
  session.recorder()->expect(points.colour.handle(), "float", fluxes);
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
  if (session.recorder() != nullptr) expect_points(session, emitter.points(), expected, largest);
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
