// SPDX-License-Identifier: MIT
// How steady light is along a sequence: its change on surfaces that stay where they are, from one frame to the next.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "device/session.hpp"
#include "image/surface_image.hpp"
#include "pipeline/frame.hpp"

namespace clpv {

/// Of each pixel of `earlier`, whether `later` sees the same surface at the same place: the pixel of `later` that its point
/// falls on shows a surface of like normal, in whose plane the point lies and no further off than pixels stand apart. What has
/// moved, is hidden, out of view or at an edge is not.
std::vector<bool> still_seen(const SurfaceImage& earlier, const SurfaceImage& later);

/// How light changed at points.
struct LightChange {
  std::size_t points = 0;
  /// Sum of all points' |after - before| over that of `before`, all channels; none without points or without light.
  std::optional<double> mean;
  /// What 95 % of the points keep to: a point's sum over channels, over the mean point's of `before`.
  std::optional<double> p95;
};

/// Of irradiance at the same points before and after, four numbers each: red, green, blue and one that does not count.
/// `counted`: whether a point does.
LightChange change_of_light(const std::vector<bool>& counted, const std::vector<float>& before,
                            const std::vector<float>& after);

/// From one frame to the next.
struct StabilityStep {
  int frame;  ///< the later one
  double seconds;
  bool still;                       ///< neither lights nor triangles changed
  std::vector<int> cascades_moved;  ///< by whole cells
  double seen;                      ///< share of the earlier frame's surfaces that this one sees too
  LightChange change;
  std::optional<double> noise;  ///< mean change between two path-traced images, where they are asked for
};

/// Takes frames one after the other. Gathers the light of each frame at the points that the frame before saw, so that nothing
/// is interpolated between pixels.
class Stability {
 public:
  /// `traced`: paths a pixel of the path-traced images; 0: none.
  Stability(Session& session, Frame& frame, std::uint32_t traced)
      : session_(session), frame_(frame), traced_(traced) {}

  /// The frame rendered last, of `scene` as it is now.
  void add(int number, double seconds, const Scene& scene, const Camera& camera);
  const std::vector<StabilityStep>& steps() const { return steps_; }

 private:
  struct Seen {
    SurfaceImage surfaces;
    std::vector<float> irradiance;  ///< four a pixel
    std::vector<ClpvGrid> grids;
    std::uint64_t content;  ///< hash of lights and triangles
  };
  std::optional<double> noise(const Scene& scene, const Camera& camera,
                              const std::vector<bool>& counted) const;

  Session& session_;
  Frame& frame_;
  std::uint32_t traced_;
  std::optional<Seen> before_;
  std::vector<StabilityStep> steps_;
};

}  // namespace clpv
