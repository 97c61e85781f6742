// SPDX-License-Identifier: MIT
// Late light carried down: the kernel against the twin, for grids that start on even and on odd cells of the coarser one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "checks/check.hpp"
#include "checks/comparison.hpp"
#include "checks/tolerances.hpp"
#include "pipeline/carry_late.hpp"
#include "pipeline/cascade.hpp"
#include "reference/carry_late.hpp"

namespace clpv::reference {
namespace {

constexpr int kGrid = 17;         // whole blocks of 8 cells and one cell more
constexpr int kCoefficients = 5;  // not whole texels
constexpr double kEdge = 4;       // of the finer grid [m]

Volume random_light(std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-1, 1);
  Volume volume(kGrid, kCoefficients);
  for (double& value : volume.values) value = uniform(random);
  return volume;
}

/// `odd`: bit a set where the camera, and so the finer grid, is one finer cell further along axis a.
CheckResult check_one(Session& session, const VolumeFormat& format, int lanes, int odd) {
  std::mt19937 random(5);
  const float cell = static_cast<float>(kEdge / kGrid);
  glm::vec3 eye(0.5f * cell);
  for (int axis = 0; axis < 3; ++axis) eye[axis] += cell * static_cast<float>(odd >> axis & 1);
  const std::vector<ClpvGrid> grids = cascade_grids(eye, 2, kEdge, kGrid);
  const VolumeShape shape{kGrid, kCoefficients, 3};
  const Volume coarser = random_light(random);
  Volume twin = random_light(random);
  clpv::Volume light(session, shape, "check: late light", format), sum(session, shape, "check: sum", format);
  light.write(session, {coarser.values.begin(), coarser.values.end()});
  sum.write(session, {twin.values.begin(), twin.values.end()});
  LateCarrier(session, shape, format, lanes).carry(light, grids[1], sum, grids[0]);
  carry_late(coarser, grids[1], twin, grids[0]);
  const Comparison apart = compare_volumes(sum.read(session), twin.values, kGrid);
  return {"carry-late", fmt::format("{}/{} lanes/starts {}", format_name(format), lanes, odd), apart.worst,
          tolerance_in("carry-late", format), apart.place};
}

}  // namespace

CheckResults check_carry_late(Session& session) {
  CheckResults results;
  std::vector<VolumeFormat> formats = other_formats(session.device(), {kGrid, kCoefficients, 3});
  formats.insert(formats.begin(), VolumeFormat{});
  for (const VolumeFormat& format : formats) {
    for (const int lanes : {1, 8}) {
      if (lanes > most_lanes(format)) continue;  // texels are loaded one by one
      for (const int odd : {0, 7, 2}) results.push_back(check_one(session, format, lanes, odd));
    }
  }
  return results;
}

}  // namespace clpv::reference
