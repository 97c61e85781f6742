// SPDX-License-Identifier: MIT
// Blockers, reflectors and visibility: kernels against CPU references on random triangles of all sizes, textured and
// masked.
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

namespace clpv::reference {
namespace {

constexpr int kGrid = 9;  // no multiple of a work-group
const ClpvGrid kCells = {{-2.5f, 0.5f, 1.0f}, 0.5f, kGrid, {}};

/// Returns "x,y,z" of the sample that contains a number, for n samples along each axis.
std::string sample_of(std::size_t number, std::size_t n) {
  return fmt::format("{},{},{}", number % n, number / n % n, number / n / n % n);
}

/// The default format and all other formats that the device supports.
std::vector<VolumeFormat> formats_of(Session& session, const VolumeShape& shape, const CheckScope& scope) {
  std::vector<VolumeFormat> formats = other_formats(session.device(), shape, scope.formats);
  formats.insert(formats.begin(), VolumeFormat{});
  return formats;
}

}  // namespace

CheckResults check_blockers(Session& session, const CheckScope& scope) {
  const Scene scene = triangle_soup();
  const SceneBuffers buffers = upload_scene(session, scene);
  const BlockerBounds expected = voxelize_blockers(scene, kCells);
  const VolumeShape shape{kGrid + 1, 3, 1};
  CheckResults results;
  const auto compare = [&](const VolumeFormat& format) {
    clpv::Volume geometry(session, shape, "check: blockers", format);
    VoxelField(session, buffers, blocker_masks(buffers, kGrid, 1, format)).update(0, kCells, geometry);
    const std::vector<float> found = geometry.read(session);
    CheckResult result{"blockers", format_name(format), 0, tolerance("blockers", format.storage), {}};
    for (std::size_t at = 0; at < found.size(); ++at) {
      const double share = found[at], lower = expected.lower.values[at], upper = expected.upper.values[at];
      result.take(std::max(lower - share, share - upper), [&] {
        return fmt::format("corner {} axis {}: {}, expected {} to {}", sample_of(at, shape.n),
                           at / (found.size() / 3), share, lower, upper);
      });
    }
    return result;
  };
  for (const VolumeFormat& format : formats_of(session, shape, scope))
    compare_selected(scope, "blockers", format_name(format), results, [&] { return compare(format); });
  return results;
}

CheckResults check_reflectors(Session& session, const CheckScope& scope) {
  const Scene scene = triangle_soup();
  const SceneBuffers buffers = upload_scene(session, scene);
  const ReflectingAreas expected = voxelize_reflectors(scene, kCells);
  CheckResults results;
  const auto compare = [&](const VolumeFormat& format) {
    clpv::Volume reflectors(session, {kGrid, kCellFaces, 3}, "check: reflectors", format);
    VoxelField(session, buffers, reflector_masks(buffers, kGrid, format)).update(0, kCells, reflectors);
    const std::vector<float> found = reflectors.read(session);
    CheckResult result{"reflectors", format_name(format), 0, tolerance("reflectors", format.storage), {}};
    for (std::size_t at = 0; at < found.size(); ++at) {
      const double wanted = expected.areas.values[at], tolerated = expected.tolerance.values[at];
      result.take(std::abs(found[at] - wanted) - tolerated, [&] {
        const std::size_t plane = at / (kGrid * kGrid * kGrid);
        return fmt::format("cell {} side {} channel {}: {:.6g}, expected {:.6g}", sample_of(at, kGrid),
                           plane % kCellFaces, plane / kCellFaces, found[at], wanted);
      });
    }
    return result;
  };
  for (const VolumeFormat& format : formats_of(session, {kGrid, kCellFaces, 3}, scope))
    compare_selected(scope, "reflectors", format_name(format), results, [&] { return compare(format); });
  return results;
}

namespace {

CheckResult compare_visibility(Session& session) {
  constexpr std::size_t kCascade = 1;  // not the first
  const Scene scene = triangle_soup();
  const SceneBuffers buffers = upload_scene(session, scene);
  const Occlusion expected = occlude(scene, kCells);
  VoxelField visibility(session, buffers, visibility_masks(kGrid, kCascade + 1));
  visibility.update(0, kCells);
  visibility.update(kCascade, kCells);
  const std::size_t bytes = visibility_bytes(kGrid);
  const auto found = session.read<std::uint8_t>(visibility.masks(), bytes * (kCascade + 1));
  CheckResult result{"visibility", "triangles", 0, tolerance("visibility"), {}};
  for (std::size_t point = 0; point < bytes; ++point) {
    const std::uint8_t bits = found[kCascade * bytes + point], lower = expected.lower[point],
                       upper = expected.upper[point];
    const unsigned wrong = (lower & ~bits) | (bits & ~upper);
    result.take(std::popcount(wrong), [&] {
      return fmt::format("cube {} point {}: {:08b}, expected {:08b} to {:08b}", sample_of(point / 64, kGrid),
                         point % 64, bits, lower, upper);
    });
  }
  return result;
}

}  // namespace

CheckResults check_visibility(Session& session, const CheckScope& scope) {
  CheckResults results;
  compare_selected(scope, "visibility", "triangles", results, [&] { return compare_visibility(session); });
  return results;
}

}  // namespace clpv::reference
