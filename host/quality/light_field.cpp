// SPDX-License-Identifier: MIT
#include "quality/light_field.hpp"

#include <algorithm>

#include "reference/view.hpp"
#include "support/error.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

reference::Volume read_light(Session& session, const Volume& volume, double scale) {
  const std::vector<float> values = volume.read(session);
  reference::Volume made;
  made.n = volume.shape().n;
  made.coefficients = volume.shape().coefficients;
  made.values.reserve(values.size());
  for (const float value : values) made.values.push_back(value / scale);
  return made;
}

bool in_reach(const ClpvGrid& grid, const glm::dvec3& position) {
  const glm::dvec3 off = glm::abs(position - glm::dvec3(grid.middle[0], grid.middle[1], grid.middle[2]));
  return glm::all(glm::lessThan(off, glm::dvec3(CLPV_GRID_REACH(grid.n) * double{grid.cell})));
}

constexpr double kFewUnreached = 0.001;  // specks at the horizon are no surprise

}  // namespace

LightField::LightField(Session& session, const Frame& frame)
    : basis_(frame.gathered()),
      transport_(frame.options().transport),
      options_(gather_options(frame.options())) {
  const GatheredLight light = frame.light();
  if (light.grids.empty())
    throw Error(ExitCode::usage, "irradiance: no frame was rendered; allowed: after a render");
  volumes_.reserve(light.grids.size());
  for (std::size_t c = 0; c < light.grids.size(); ++c) {
    volumes_.push_back(read_light(session, *light.accumulated[c], light.scale));
    cascades_.push_back({light.grids[c], &volumes_.back()});
  }
  if (light.occluded == nullptr) return;
  const std::size_t bytes = CellVisibility::bytes(options_.grid);
  occluded_ = session.read<std::uint8_t>(*light.occluded, bytes * cascades_.size());
  for (std::size_t c = 0; c < cascades_.size(); ++c) cascades_[c].occluded = occluded_.data() + c * bytes;
}

glm::dvec3 LightField::irradiance(const glm::dvec3& position, const glm::dvec3& normal) const {
  return reference::gather(basis_, transport_, options_, cascades_, position, normal);
}

bool LightField::reaches(const glm::dvec3& position) const {
  return in_reach(cascades_.back().grid, position);
}

double unreached_share(Session& session, const Frame& frame) {
  const Surface& seen = frame.seen();
  const ClpvView& view = seen.view;
  const ClpvGrid coarsest = frame.light().grids.back();
  const std::vector<float> depths = session.read<float>(seen.depth, std::size_t{view.width} * view.height);
  std::size_t surfaces = 0, unreached = 0;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (depths[i] == 0) continue;
    ++surfaces;
    unreached += !in_reach(coarsest, reference::surface_position(view, i, depths[i]));
  }
  return surfaces == 0 ? 0 : static_cast<double>(unreached) / static_cast<double>(surfaces);
}

void warn_of_unreached(Session& session, const Frame& frame, const std::string& camera) {
  const double share = unreached_share(session, frame);
  if (share <= kFewUnreached) return;
  spdlog::warn(
      "camera '{}': {:.1f} % of the visible surface lies outside the cascades and has no indirect light; a "
      "larger "
      "--cascade-size or more --cascades reach farther",
      camera, 100 * share);
}

}  // namespace clpv
