// SPDX-License-Identifier: MIT
// Triangles that block: the kernels against the twin on a soup of triangles, of all sizes and with holes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "checks/check.hpp"
#include "checks/check_inputs.hpp"
#include "checks/tolerances.hpp"
#include "pipeline/block.hpp"
#include "reference/block.hpp"

namespace clpv::reference {
namespace {

constexpr int kGrid = 9;  // no multiple of anything
const ClpvGrid kCells = {{-2.5f, 0.5f, 1.0f}, 0.5f, kGrid, {}};

CheckResult check_one(Session& session, const Scene& scene, const Blocked& twin, const VolumeFormat& format) {
  const VolumeShape shape{kGrid + 1, 3, 1};
  clpv::Volume geometry(session, shape, "check: blockers", format);
  const SceneBuffers buffers = upload_scene(session, scene);
  SceneBlocker(session, buffers, kGrid, 1, format).block(0, kCells, geometry);
  const std::vector<float> found = geometry.read(session);
  CheckResult result{"block", format_name(format), 0, tolerance_in("block", format), {}};
  for (std::size_t at = 0; at < found.size(); ++at) {
    const double share = found[at];
    const double outside = std::max(twin.least.values[at] - share, share - twin.most.values[at]);
    result.take(outside, [&] {
      const std::size_t n = kGrid + 1;
      return fmt::format("corner {},{},{} axis {}: {}, twin {} to {}", at % n, at / n % n, at / n / n % n,
                         at / n / n / n, share, twin.least.values[at], twin.most.values[at]);
    });
  }
  return result;
}

}  // namespace

CheckResults check_block(Session& session) {
  const Scene scene = triangle_soup();
  const Blocked twin = block(scene, kCells);
  CheckResults results{check_one(session, scene, twin, {})};
  for (const VolumeFormat& format : other_formats(session.device(), {kGrid + 1, 3, 1}))
    results.push_back(check_one(session, scene, twin, format));
  return results;
}

}  // namespace clpv::reference
