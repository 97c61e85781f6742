// SPDX-License-Identifier: MIT
// Light scattered by a medium: kernels against CPU reference, under a sun, a spot and a point light
// and in random light of two cascades.
#include "pipeline/gather/medium.hpp"

#include <memory>
#include <random>

#include "basis/sweep.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/gather/gather.hpp"
#include "reference/medium.hpp"
#include "verify/check.hpp"
#include "verify/expected.hpp"
#include "verify/inputs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::verify {
namespace {

constexpr int kMediumGrid = 9, kMediumCascades = 2;
constexpr double kMediumFinestEdge = 6;  // [m]

const ClpvMedium kFog{{-2, -1.5f, -7},     {4, 3, 2}, {0.1f, 0.3f, 0.5f},
                      {0.15f, 0.3f, 0.9f}, 0.5f,      {}};
const ClpvMedium kDust{{-20, -20, -20},       {20, 20, 20}, {1e-5f, 2e-5f, 0},
                       {1e-5f, 2e-5f, 1e-5f}, -0.3f,        {}};

Deviation compare_medium(Session& session, const ClpvMedium& medium) {
  std::mt19937 random(31);
  const std::unique_ptr<Basis> basis = swept_basis();
  const SurfaceImage image = random_surfaces(random);
  const std::vector<reference::MappedLight> lights = lights_in(medium);
  const CascadeLight cascades =
      random_cascades(*basis, kMediumCascades, kMediumFinestEdge, kMediumGrid, true, {}, random);
  const CascadesOnDevice light(session, cascades, {});
  const MediumOptions options{.gather = {.grid = kMediumGrid, .packed = true}};

  const Surface camera = upload_surface(session, image);
  Buffer pixels = session.buffer(image.depth.size() * sizeof(cl_float4), "check: irradiance");
  Gatherer gatherer(session, *basis, TransportKind::sweep, options.gather);
  gatherer.gather(camera, light.gathered(), pixels);
  MediumLight scattered(session, *basis, medium, options);
  scattered.scatter(camera, gatherer, on_device(session, lights));
  scattered.add(camera, true, pixels);

  std::vector<double> expected;
  for (const glm::dvec3& wanted :
       reference::scattered_light(*basis, options, {medium, lights, light.cascades}, image))
    append_pixel(expected, wanted, 1);
  expect_pixels(session, pixels, expected, tolerance("medium"));
  return compare_pixels(session.read<cl_float4>(pixels, image.depth.size()), expected,
                        image.view.width, tolerance("medium"));
}

}  // namespace

Cases medium_cases(const CheckScope&) {
  return {deviation_case(Stage::medium, "fog",
                         [](Session& session) { return compare_medium(session, kFog); }),
          deviation_case(Stage::medium, "dust",
                         [](Session& session) { return compare_medium(session, kDust); })};
}

}  // namespace clpv::verify
