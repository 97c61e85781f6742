// SPDX-License-Identifier: MIT
// Blockers, reflectors and visibility: kernels against CPU references on random triangles of all
// sizes, textured and masked.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "basis/bounce.hpp"
#include "kernels/shared/reflectors.h"
#include "pipeline/voxels/blockers.hpp"
#include "pipeline/voxels/reflectors.hpp"
#include "pipeline/voxels/visibility.hpp"
#include "reference/blockers.hpp"
#include "reference/reflectors.hpp"
#include "reference/visibility.hpp"
#include "verify/check.hpp"
#include "verify/expected.hpp"
#include "verify/inputs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::verify {
namespace {

constexpr int kTrianglesGrid = 9;  // no multiple of a work-group
const ClpvGrid kTrianglesCells = {{-2.5f, 0.5f, 1.0f}, 0.5f, kTrianglesGrid, {}};

/// Returns "x,y,z" of the sample that contains a number, for n samples along each axis.
std::string sample_of(std::size_t number, std::size_t n) {
  return fmt::format("{},{},{}", number % n, number / n % n, number / n / n % n);
}

/// One case per volume format, the default first.
Cases cases_of_formats(Stage stage, const CheckScope& scope,
                       const std::function<Deviation(Session&, const VolumeFormat&)>& compare) {
  std::vector<VolumeFormat> formats = scope.formats;
  formats.insert(formats.begin(), VolumeFormat{});
  Cases cases;
  for (const VolumeFormat& format : formats) {
    cases.push_back(deviation_case(stage, format_name(format),
                                   [=](Session& session) { return compare(session, format); }));
  }
  return cases;
}

Deviation compare_blockers(Session& session, const VolumeFormat& format) {
  const SceneData scene = triangle_soup();
  const SceneBuffers buffers = upload_scene(session, scene);
  Volume geometry(session, {kTrianglesGrid + 1, 3, 1}, "check: blockers", format);
  VoxelField(session, buffers, blocker_masks(buffers, kTrianglesGrid, 1, format))
      .update(0, kTrianglesCells, geometry);
  const std::vector<float> found = geometry.read(session);
  const reference::BlockerBounds expected = reference::voxelize_blockers(scene, kTrianglesCells);
  Ranges ranges;
  for (std::size_t at = 0; at < found.size(); ++at)
    ranges.push_back({expected.lower.values[at], expected.upper.values[at]});
  expect(session, geometry, ranges);
  Deviation result{0, tolerance("blockers", format.storage)};
  for (std::size_t at = 0; at < found.size(); ++at) {
    const double share = found[at], lower = expected.lower.values[at],
                 upper = expected.upper.values[at];
    result.take(std::max(lower - share, share - upper), [&] {
      return fmt::format("corner {} axis {}: {}, expected {} to {}",
                         sample_of(at, kTrianglesGrid + 1), at / (found.size() / 3), share, lower,
                         upper);
    });
  }
  return result;
}

Deviation compare_reflectors(Session& session, const VolumeFormat& format, bool white) {
  const SceneData scene = triangle_soup();
  const SceneBuffers buffers = upload_scene(session, scene);
  Volume reflectors(session, {kTrianglesGrid, kCellFaces, CLPV_REFLECTOR_CHANNELS},
                    "check: reflectors", format);
  VoxelField(session, buffers, reflector_masks(buffers, kTrianglesGrid, format, white))
      .update(0, kTrianglesCells, reflectors);
  const std::vector<float> found = reflectors.read(session);
  const reference::ReflectingAreas expected =
      reference::voxelize_reflectors(scene, kTrianglesCells, white);
  Deviation result{0, tolerance("reflectors", format.storage)};
  Ranges ranges;
  for (std::size_t at = 0; at < found.size(); ++at) {
    const double wanted = expected.areas.values[at],
                 tolerated = expected.tolerance.values[at] + result.allowed;
    ranges.push_back({wanted - tolerated, wanted + tolerated});
  }
  expect(session, reflectors, ranges);
  for (std::size_t at = 0; at < found.size(); ++at) {
    const double wanted = expected.areas.values[at], tolerated = expected.tolerance.values[at];
    result.take(std::abs(found[at] - wanted) - tolerated, [&] {
      const std::size_t plane = at / (kTrianglesGrid * kTrianglesGrid * kTrianglesGrid);
      return fmt::format("cell {} side {} channel {}: {:.6g}, expected {:.6g}",
                         sample_of(at, kTrianglesGrid), plane % kCellFaces, plane / kCellFaces,
                         found[at], wanted);
    });
  }
  return result;
}

Deviation compare_visibility(Session& session) {
  constexpr std::size_t kCascade = 1;  // not the first
  const SceneData scene = triangle_soup();
  const SceneBuffers buffers = upload_scene(session, scene);
  const reference::Occlusion expected = reference::occlude(scene, kTrianglesCells);
  VoxelField visibility(session, buffers, visibility_masks(kTrianglesGrid, kCascade + 1));
  visibility.update(0, kTrianglesCells);
  visibility.update(kCascade, kTrianglesCells);
  const std::size_t bytes = visibility_bytes(kTrianglesGrid);
  const auto found = session.read<std::uint8_t>(visibility.masks(), bytes * (kCascade + 1));
  Ranges ranges(kCascade * bytes);
  for (std::size_t point = 0; point < bytes; ++point)
    ranges.push_back({double(expected.lower[point]), double(expected.upper[point])});
  if (session.recorder() != nullptr)
    session.recorder()->expect(visibility.masks().handle(), "bits", ranges);
  Deviation result{0, tolerance("visibility")};
  for (std::size_t point = 0; point < bytes; ++point) {
    const std::uint8_t bits = found[kCascade * bytes + point], lower = expected.lower[point],
                       upper = expected.upper[point];
    const unsigned wrong = (lower & ~bits) | (bits & ~upper);
    result.take(std::popcount(wrong), [&] {
      return fmt::format("cube {} point {}: {:08b}, expected {:08b} to {:08b}",
                         sample_of(point / 64, kTrianglesGrid), point % 64, bits, lower, upper);
    });
  }
  return result;
}

}  // namespace

Cases blockers_cases(const CheckScope& scope) {
  return cases_of_formats(Stage::blockers, scope, compare_blockers);
}

Cases reflectors_cases(const CheckScope& scope) {
  Cases cases =
      cases_of_formats(Stage::reflectors, scope, [](Session& session, const VolumeFormat& format) {
        return compare_reflectors(session, format, false);
      });
  cases.push_back(deviation_case(Stage::reflectors, "white", [](Session& session) {
    return compare_reflectors(session, {}, true);
  }));
  return cases;
}

Cases visibility_cases(const CheckScope&) {
  return {deviation_case(Stage::visibility, "triangles", compare_visibility)};
}

}  // namespace clpv::verify
