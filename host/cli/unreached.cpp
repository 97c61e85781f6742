// SPDX-License-Identifier: MIT
#include "cli/unreached.hpp"

#include <vector>

#include "pipeline/frame/cascade.hpp"
#include "reference/view.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

constexpr double kFewUnreached = 0.001;  // ignores specks at the horizon

}  // namespace

double unreached_share(Session& session, const Frame& frame) {
  const Surface& seen = frame.seen();
  const ClpvView& view = seen.view;
  const ClpvGrid coarsest = frame.light().grids.back();
  const std::vector<float> depths =
      session.read<float>(seen.depth, std::size_t{view.width} * view.height);
  std::size_t surfaces = 0, unreached = 0;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (depths[i] == 0) continue;
    ++surfaces;
    unreached += !reaches(coarsest, reference::surface_position(view, i, depths[i]));
  }
  return surfaces == 0 ? 0 : static_cast<double>(unreached) / static_cast<double>(surfaces);
}

void warn_of_unreached(Session& session, const Frame& frame, const std::string& camera) {
  const double share = unreached_share(session, frame);
  if (share <= kFewUnreached) return;
  log_warning(
      "camera '{}': {:.1f} % of the visible surface lies outside the cascades and has no indirect "
      "light, and a sky shines in where they end; a larger --cascade-size or more --cascades reach "
      "farther",
      camera, 100 * share);
}

}  // namespace clpv
