// SPDX-License-Identifier: MIT
// Gathering: kernels against CPU reference, on random light in three nested cascades, for surfaces in and around them.
#include "pipeline/gather/gather.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <random>

#include "basis/sweep.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/voxels/visibility.hpp"
#include "reference/gather.hpp"
#include "verify/check.hpp"
#include "verify/inputs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::reference {
namespace {

constexpr int kGrid = 9;  // odd, so that no pitch is a power of two
constexpr int kCascades = 3;
constexpr double kFinestEdge = 4;  // [m]; the coarsest is 16 m across

struct Variant {
  std::string name;
  LobeOptions lobes = {};
  TableStorage table = TableStorage::buffer;
  VolumeFormat format = {};
  bool filtered = true;  ///< images only
  Gathering gather = Gathering::all;
};

/// One byte per point between cells of all cascades; each cell is occluded from half of them.
std::vector<std::uint8_t> random_occlusion(std::mt19937& random) {
  std::vector<std::uint8_t> occluded(kCascades * visibility_bytes(kGrid));
  for (std::uint8_t& bits : occluded) bits = random() % 256;
  return occluded;
}

std::string_view compared_as(const Variant& variant) {
  if (variant.gather == Gathering::visible) return "gather-visible";
  return variant.format.layout == Layout::image && variant.filtered ? "gather-filter" : "gather";
}

CheckResult check_one(Session& session, const Basis& basis, TransportKind transport, const Variant& variant) {
  std::mt19937 random(11);
  SurfaceImage image = random_surfaces(random);
  for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
    if (rounding_decides(basis, variant.lobes, glm::dvec3(image.normal[pixel]))) image.depth[pixel] = 0;
  }
  const std::vector<ClpvGrid> grids = cascade_grids({0.1f, 0.2f, 0.3f}, kCascades, kFinestEdge, kGrid);
  const GatherOptions options{.grid = kGrid,
                              .gather = variant.gather,
                              .lobes = variant.lobes,
                              .table = variant.table,
                              .format = variant.format,
                              .filtered = variant.filtered};
  const bool visible = variant.gather == Gathering::visible;
  const std::vector<std::uint8_t> occluded = random_occlusion(random);
  const Buffer occluded_on_device = session.upload(occluded, "check: occluded cells");
  std::vector<Volume> light;
  std::vector<clpv::Volume> lit;
  for (int c = 0; c < kCascades; ++c) {
    light.push_back(random_light(basis, kGrid, random));
    lit.push_back(on_device(session, light.back(), variant.format));
  }
  std::vector<const clpv::Volume*> volumes;
  std::vector<Cascade> cascades;
  for (int c = 0; c < kCascades; ++c) {
    volumes.push_back(&lit[c]);
    cascades.push_back({grids[c], &light[c], occluded.data() + c * visibility_bytes(kGrid)});
  }
  const Surface camera = upload_surface(session, image);
  Buffer irradiance = session.buffer(image.depth.size() * sizeof(cl_float4), "check: irradiance");
  Gatherer(session, basis, transport, options)
      .gather(camera, {grids, volumes, 1, visible ? occluded_on_device : Buffer()}, irradiance);
  std::vector<glm::dvec4> expected;
  for (const glm::dvec3& e : gather(basis, transport, options, cascades, image))
    expected.emplace_back(e, 0.0);
  CheckResult result = compare_pixels(session.read<cl_float4>(irradiance, image.depth.size()), expected,
                                      image.view.width, "gather", variant.name);
  result.allowed = tolerance(compared_as(variant), variant.format.storage);
  return result;
}

void compare(Session& session, const CheckScope& scope, const Basis& basis, TransportKind transport,
             const Variant& variant, CheckResults& results) {
  compare_selected(scope, "gather", fmt::format("{}/{}/{}", basis.name(), name_of(transport), variant.name),
                   results, [&] { return check_one(session, basis, transport, variant); });
}

/// Tests all other volume formats; images both with the device's filter and from texels.
void check_formats(Session& session, const CheckScope& scope, CheckResults& results) {
  const std::unique_ptr<Basis> basis = make_basis("sh2");
  constexpr TransportKind transport = TransportKind::sweep;
  for (const VolumeFormat& format :
       other_formats(session.device(), {kGrid, basis->size(), 3}, scope.formats)) {
    Variant variant{.name = format_name(format), .format = format};
    if (format.layout == Layout::image) {
      variant.name += " filter";
      compare(session, scope, *basis, transport, variant, results);
      variant.name = format_name(format) + " texels";
      variant.filtered = false;
    }
    compare(session, scope, *basis, transport, variant, results);
    variant.gather = Gathering::visible;
    variant.name += " visible";
    compare(session, scope, *basis, transport, variant, results);
  }
}

}  // namespace

CheckResults check_gather(Session& session, const CheckScope& scope) {
  CheckResults results;
  for (const std::string& name : scope.bases) {
    const std::unique_ptr<Basis> basis = make_basis(name);
    if (!scope.thorough && name == "sh2") continue;  // sh3 has the same code
    compare(session, scope, *basis, TransportKind::sampled, {"plain"}, results);
    if (scope.thorough || name == "sh3") {
      compare(session, scope, *basis, TransportKind::sampled,
              {.name = "visible", .gather = Gathering::visible}, results);
    }
    if (basis->centres().empty()) continue;  // no table
    if (!scope.thorough && basis->size() > 4) continue;
    const LobeOptions functions{.table_functions = true};
    compare(session, scope, *basis, TransportKind::sampled, {"table", functions}, results);
    if (!session.device().images) continue;
    compare(session, scope, *basis, TransportKind::sampled, {"table image", functions, TableStorage::image},
            results);
  }
  const std::unique_ptr<Basis> swept = swept_basis();  // all bases of swept light
  compare(session, scope, *swept, TransportKind::sweep, {"plain"}, results);
  compare(session, scope, *swept, TransportKind::sweep, {.name = "visible", .gather = Gathering::visible},
          results);
  check_formats(session, scope, results);
  return results;
}

}  // namespace clpv::reference
