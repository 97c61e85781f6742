// SPDX-License-Identifier: MIT
// Blockers, reflectors and visibility: kernels against CPU references on random triangles of all
// sizes, textured and masked.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "basis/bounce.hpp"
#include "pipeline/voxels/blockers.hpp"
#include "pipeline/voxels/reflectors.hpp"
#include "pipeline/voxels/visibility.hpp"
#include "reference/blockers.hpp"
#include "reference/reflectors.hpp"
#include "reference/visibility.hpp"
#include "verify/check.hpp"
#include "verify/inputs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::verify {
namespace {

constexpr int kGrid = 9;  // no multiple of a work-group
const ClpvGrid kCells = {{-2.5f, 0.5f, 1.0f}, 0.5f, kGrid, {}};

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
  Volume geometry(session, {kGrid + 1, 3, 1}, "check: blockers", format);
  VoxelField(session, buffers, blocker_masks(buffers, kGrid, 1, format))
      .update(0, kCells, geometry);
  const std::vector<float> found = geometry.read(session);
  const reference::BlockerBounds expected = reference::voxelize_blockers(scene, kCells);
  Deviation result{0, tolerance("blockers", format.storage)};
  for (std::size_t at = 0; at < found.size(); ++at) {
    const double share = found[at], lower = expected.lower.values[at],
                 upper = expected.upper.values[at];
    result.take(std::max(lower - share, share - upper), [&] {
      return fmt::format("corner {} axis {}: {}, expected {} to {}", sample_of(at, kGrid + 1),
                         at / (found.size() / 3), share, lower, upper);
    });
  }
  return result;
}

Deviation compare_reflectors(Session& session, const VolumeFormat& format) {
  const SceneData scene = triangle_soup();
  const SceneBuffers buffers = upload_scene(session, scene);
  Volume reflectors(session, {kGrid, kCellFaces, 3}, "check: reflectors", format);
  VoxelField(session, buffers, reflector_masks(buffers, kGrid, format))
      .update(0, kCells, reflectors);
  const std::vector<float> found = reflectors.read(session);
  const reference::ReflectingAreas expected = reference::voxelize_reflectors(scene, kCells);
  Deviation result{0, tolerance("reflectors", format.storage)};
  for (std::size_t at = 0; at < found.size(); ++at) {
    const double wanted = expected.areas.values[at], tolerated = expected.tolerance.values[at];
    result.take(std::abs(found[at] - wanted) - tolerated, [&] {
      const std::size_t plane = at / (kGrid * kGrid * kGrid);
      return fmt::format("cell {} side {} channel {}: {:.6g}, expected {:.6g}",
                         sample_of(at, kGrid), plane % kCellFaces, plane / kCellFaces, found[at],
                         wanted);
    });
  }
  return result;
}

Deviation compare_visibility(Session& session) {
  constexpr std::size_t kCascade = 1;  // not the first
  const SceneData scene = triangle_soup();
  const SceneBuffers buffers = upload_scene(session, scene);
  const reference::Occlusion expected = reference::occlude(scene, kCells);
  VoxelField visibility(session, buffers, visibility_masks(kGrid, kCascade + 1));
  visibility.update(0, kCells);
  visibility.update(kCascade, kCells);
  const std::size_t bytes = visibility_bytes(kGrid);
  const auto found = session.read<std::uint8_t>(visibility.masks(), bytes * (kCascade + 1));
  Deviation result{0, tolerance("visibility")};
  for (std::size_t point = 0; point < bytes; ++point) {
    const std::uint8_t bits = found[kCascade * bytes + point], lower = expected.lower[point],
                       upper = expected.upper[point];
    const unsigned wrong = (lower & ~bits) | (bits & ~upper);
    result.take(std::popcount(wrong), [&] {
      return fmt::format("cube {} point {}: {:08b}, expected {:08b} to {:08b}",
                         sample_of(point / 64, kGrid), point % 64, bits, lower, upper);
    });
  }
  return result;
}

}  // namespace

Cases blockers_cases(const CheckScope& scope) {
  return cases_of_formats(Stage::blockers, scope, compare_blockers);
}

Cases reflectors_cases(const CheckScope& scope) {
  return cases_of_formats(Stage::reflectors, scope, compare_reflectors);
}

Cases visibility_cases(const CheckScope&) {
  return {deviation_case(Stage::visibility, "triangles", compare_visibility)};
}

}  // namespace clpv::verify
