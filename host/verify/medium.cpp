// SPDX-License-Identifier: MIT
// Light scattered by a medium: kernels against CPU reference, under a sun, a spot and a point light and in random light of
// two cascades.
#include "pipeline/gather/medium.hpp"

#include <memory>
#include <random>

#include "basis/sweep.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/gather/gather.hpp"
#include "reference/medium.hpp"
#include "verify/check.hpp"
#include "verify/inputs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::reference {
namespace {

constexpr int kMediumGrid = 9, kMediumCascades = 2;
constexpr double kMediumFinestEdge = 6;  // [m]

struct MediumVariant {
  std::string name;
  ClpvMedium medium;
};

const ClpvMedium kFog{{-2, -1.5f, -7}, {4, 3, 2}, {0.1f, 0.3f, 0.5f}, {0.15f, 0.3f, 0.9f}, 0.5f, {}};
const ClpvMedium kDust{{-20, -20, -20}, {20, 20, 20}, {1e-5f, 2e-5f, 0}, {1e-5f, 2e-5f, 1e-5f}, -0.3f, {}};

CheckResult check_one_medium(Session& session, const MediumVariant& variant) {
  std::mt19937 random(31);
  const std::unique_ptr<Basis> basis = swept_basis();
  const SurfaceImage image = random_surfaces(random);
  const std::vector<MappedLight> lights = lights_in(variant.medium);
  const std::vector<ClpvGrid> grids =
      cascade_grids({0.1f, 0.2f, 0.3f}, kMediumCascades, kMediumFinestEdge, kMediumGrid);
  std::vector<Volume> light;
  std::vector<clpv::Volume> lit;
  for (int c = 0; c < kMediumCascades; ++c) {
    light.push_back(random_light(*basis, kMediumGrid, random));
    lit.push_back(on_device(session, light.back(), {}));
  }
  std::vector<const clpv::Volume*> volumes;
  std::vector<Cascade> cascades;
  for (int c = 0; c < kMediumCascades; ++c) {
    volumes.push_back(&lit[c]);
    cascades.push_back({grids[c], &light[c], nullptr});
  }
  const MediumOptions options{.gather = {.grid = kMediumGrid, .packed = true}};

  const Surface camera = upload_surface(session, image);
  Buffer pixels = session.buffer(image.depth.size() * sizeof(cl_float4), "check: irradiance");
  Gatherer gatherer(session, *basis, TransportKind::sweep, options.gather);
  gatherer.gather(camera, {grids, volumes}, pixels);
  MediumLight scattered(session, *basis, variant.medium, options);
  scattered.scatter(camera, gatherer, on_device(session, lights));
  scattered.add(camera, true, pixels);

  std::vector<glm::dvec4> expected;
  for (const glm::dvec3& wanted : scattered_light(*basis, options, {variant.medium, lights, cascades}, image))
    expected.emplace_back(wanted, 1);
  CheckResult result = compare_pixels(session.read<cl_float4>(pixels, image.depth.size()), expected,
                                      image.view.width, "medium", variant.name);
  result.allowed = tolerance("medium", Storage::float32);
  return result;
}

}  // namespace

CheckResults check_medium(Session& session, const CheckScope& scope) {
  CheckResults results;
  for (const MediumVariant& variant : {MediumVariant{"fog", kFog}, MediumVariant{"dust", kDust}})
    compare_selected(scope, "medium", variant.name, results,
                     [&] { return check_one_medium(session, variant); });
  return results;
}

}  // namespace clpv::reference
