// Gathering: kernels against the twin, on random light in three nested cascades seen by surfaces in and round
// them.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <random>

#include "pipeline/cascade.hpp"
#include "pipeline/gather.hpp"
#include "reference/check.hpp"
#include "reference/gather.hpp"
#include "reference/tolerances.hpp"

namespace clpv::reference {
namespace {

constexpr int kGrid = 9;  // odd, so that no pitch is a power of two
constexpr int kCascades = 3;
constexpr double kFinestEdge = 4;  // [m]; the coarsest is 16 m across
constexpr int kWidth = 45, kHeight = 31;
constexpr float kFarthest = 12;  // [m] from an eye near the middle: some surfaces lie outside all cascades

Volume random_light(int coefficients, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-1, 1);
  Volume volume(kGrid, coefficients);
  for (double& value : volume.values) value = uniform(random);
  return volume;
}

/// Surfaces at random depths, turned at random; a tenth of the pixels see none.
SurfaceImage random_surfaces(std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(0, 1);
  SurfaceImage image;
  ClpvView& view = image.view;
  view.eye[0] = 0.3f, view.eye[1] = -0.2f, view.eye[2] = 0.6f;
  view.right[2] = view.up[1] = view.forward[0] = 1;
  view.half_width = 1.2f, view.half_height = 0.8f;
  view.near_depth = 0.01f, view.far_depth = 100;
  view.width = kWidth, view.height = kHeight;
  for (int pixel = 0; pixel < kWidth * kHeight; ++pixel) {
    const float depth = 1.1f * uniform(random) - 0.1f;
    const glm::vec3 n(uniform(random) - 0.5f, uniform(random) - 0.5f, uniform(random) - 0.4995f);
    image.depth.push_back(depth > 0 ? kFarthest * depth * depth : 0.0f);
    image.normal.emplace_back(glm::normalize(n), 0.0f);
  }
  image.colour.assign(image.depth.size(), glm::vec4(0));
  image.emissive = image.colour;
  return image;
}

struct Variant {
  std::string name;
  bool late_light = false;
  double floor = 0;
};

/// One cascade's sums, on the device and for the twin.
struct Lit {
  Volume twin;
  clpv::Volume device;
  Lit(Session& session, int coefficients, std::mt19937& random)
      : twin(random_light(coefficients, random)), device(session, {kGrid, coefficients, 3}, "check: light") {
    device.write(session, {twin.values.begin(), twin.values.end()});
  }
};

CheckResult compare(const std::vector<cl_float4>& device, const std::vector<glm::dvec3>& twin,
                    const std::string& variant) {
  CheckResult result{"gather", variant, 0, tolerance("gather"), {}};
  double largest = 0;
  for (const glm::dvec3& e : twin) largest = std::max({largest, e.x, e.y, e.z});
  for (std::size_t at = 0; at < 3 * twin.size(); ++at) {
    const std::size_t pixel = at / 3;
    const int channel = static_cast<int>(at % 3);
    const double error = std::abs(double{device[pixel].s[channel]} - twin[pixel][channel]) / largest;
    if (error <= result.worst) continue;  // a NaN is not, and stays the worst
    result.worst = error;
    result.place = fmt::format("pixel {},{} channel {}: {:.7g}, twin {:.7g}", pixel % kWidth, pixel / kWidth,
                               channel, device[pixel].s[channel], twin[pixel][channel]);
    if (std::isnan(error)) break;
  }
  return result;
}

CheckResult check_one(Session& session, const Basis& basis, const Transport& transport,
                      const Variant& variant) {
  std::mt19937 random(11);
  const SurfaceImage image = random_surfaces(random);
  const std::vector<ClpvGrid> grids = cascade_grids({0.1f, 0.2f, 0.3f}, kCascades, kFinestEdge, kGrid);
  const GatherOptions options{.grid = kGrid, .late_light = variant.late_light, .floor = variant.floor};
  std::vector<Lit> full, late;
  for (int c = 0; c < kCascades; ++c) {
    full.emplace_back(session, basis.size(), random);
    if (variant.late_light) late.emplace_back(session, basis.size(), random);
  }
  std::vector<const clpv::Volume*> full_volumes, late_volumes;
  std::vector<Cascade> cascades;
  for (std::size_t c = 0; c < grids.size(); ++c) {
    full_volumes.push_back(&full[c].device);
    if (variant.late_light) late_volumes.push_back(&late[c].device);
    cascades.push_back({grids[c], &full[c].twin, variant.late_light ? &late[c].twin : nullptr});
  }
  Surface camera;
  camera.view = image.view;
  camera.depth = session.upload(image.depth, "check: depth");
  camera.normal = session.upload(image.normal, "check: normal");
  cl::Buffer irradiance = session.buffer(image.depth.size() * sizeof(cl_float4), "check: irradiance");
  Gatherer(session, basis, transport, options).gather(camera, grids, full_volumes, late_volumes, irradiance);
  return compare(session.read<cl_float4>(irradiance, image.depth.size()),
                 gather(basis, transport, options, cascades, image),
                 fmt::format("{}/{}/{}", basis.name(), transport.name, variant.name));
}

}  // namespace

CheckResults check_gather(Session& session) {
  CheckResults results;
  for (const std::string& name : basis_names()) {
    const std::unique_ptr<Basis> basis = make_basis(name);
    // One transport that gathers radiant intensity, one that gathers through its own matrix.
    results.push_back(check_one(session, *basis, make_transport("sampled", *basis), {"plain"}));
    results.push_back(
        check_one(session, *basis, make_transport("upwind", *basis), {"late, floor", true, 0.15}));
  }
  return results;
}

}  // namespace clpv::reference
