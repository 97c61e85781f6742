// SPDX-License-Identifier: MIT
// Triangles that reflect: the kernels against the twin on a soup of triangles, of all sizes, textured and with holes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "basis/bounce.hpp"
#include "checks/check.hpp"
#include "checks/check_inputs.hpp"
#include "checks/tolerances.hpp"
#include "pipeline/reflect.hpp"
#include "reference/reflect.hpp"

namespace clpv::reference {
namespace {

constexpr int kGrid = 9;  // no multiple of anything
const ClpvGrid kCells = {{-2.5f, 0.5f, 1.0f}, 0.5f, kGrid, {}};

CheckResult check_one(Session& session, const Scene& scene, const Reflected& twin,
                      const VolumeFormat& format) {
  const SceneBuffers buffers = upload_scene(session, scene);
  SceneReflector reflector(session, buffers, kGrid, 1, format);
  reflector.reflect(0, kCells);
  const std::vector<float> found = reflector.reflectors(0).read(session);
  CheckResult result{"reflect", format_name(format), 0, tolerance_in("reflect", format), {}};
  for (std::size_t at = 0; at < found.size(); ++at) {
    const double wanted = twin.areas.values[at], doubt = twin.doubt.values[at];
    result.take(std::abs(found[at] - wanted) - doubt, [&] {
      const std::size_t n = kGrid, cell = at % (n * n * n), plane = at / (n * n * n);
      return fmt::format("cell {},{},{} side {} channel {}: {:.6g}, twin {:.6g}", cell % n, cell / n % n,
                         cell / n / n, plane % kReflectingSides, plane / kReflectingSides, found[at], wanted);
    });
  }
  return result;
}

}  // namespace

CheckResults check_reflect(Session& session) {
  const Scene scene = triangle_soup();
  const Reflected twin = reflect(scene, kCells);
  CheckResults results{check_one(session, scene, twin, {})};
  for (const VolumeFormat& format : other_formats(session.device(), {kGrid, kReflectingSides, 3}))
    results.push_back(check_one(session, scene, twin, format));
  return results;
}

}  // namespace clpv::reference
