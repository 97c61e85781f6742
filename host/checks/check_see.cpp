// SPDX-License-Identifier: MIT
// What triangles hide: the kernel against the twin on a soup of triangles, of all sizes and with holes.
#include <fmt/format.h>

#include <bit>

#include "checks/check.hpp"
#include "checks/check_inputs.hpp"
#include "checks/tolerances.hpp"
#include "pipeline/see.hpp"
#include "reference/see.hpp"

namespace clpv::reference {
namespace {

constexpr int kGrid = 9;
constexpr std::size_t kCascade = 1;  // none is the first
const ClpvGrid kCells = {{-2.5f, 0.5f, 1.0f}, 0.5f, kGrid, {}};

}  // namespace

CheckResults check_see(Session& session) {
  const Scene scene = triangle_soup();
  const Hidden twin = see(scene, kCells);
  const SceneBuffers buffers = upload_scene(session, scene);
  SceneSight sight(session, buffers, kGrid, kCascade + 1);
  sight.see(0, kCells);
  sight.see(kCascade, kCells);
  const std::size_t bytes = SceneSight::bytes(kGrid);
  const auto found = session.read<std::uint8_t>(sight.hidden(), bytes * (kCascade + 1));
  CheckResult result{"see", "triangles", 0, tolerance("see"), {}};
  for (std::size_t point = 0; point < bytes; ++point) {
    const unsigned bits = found[kCascade * bytes + point];
    const auto wrong =
        static_cast<std::uint8_t>((twin.least[point] & ~bits) | (bits & ~unsigned{twin.most[point]}));
    result.take(std::popcount(wrong), [&] {
      const std::size_t cube = point / 64, n = kGrid;
      return fmt::format("cube {},{},{} point {}: {:08b}, twin {:08b} to {:08b}", cube % n, cube / n % n,
                         cube / n / n, point % 64, bits, twin.least[point], twin.most[point]);
    });
  }
  return {result};
}

}  // namespace clpv::reference
