// SPDX-License-Identifier: MIT
// Temporal stability of light in a sequence: its change between frames on static surfaces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "device/session.hpp"
#include "image/image.hpp"
#include "pipeline/frame/frame.hpp"

namespace clpv {

constexpr std::size_t kNotSeen = static_cast<std::size_t>(-1);

/// Returns, for each pixel of `earlier`, the pixel of `later` that sees the same surface at the
/// same position, or kNotSeen. Its point is projected to a pixel of `later`, which must show a
/// similar normal, the same plane and a point within the pixel spacing. Moved, hidden and
/// out-of-view points and edges do not match.
std::vector<std::size_t> later_pixels(const SurfaceImage& earlier, const SurfaceImage& later);
/// Whether there is such a pixel.
std::vector<bool> still_seen(const SurfaceImage& earlier, const SurfaceImage& later);

/// Change of light at points.
struct LightChange {
  std::size_t points = 0;
  /// Sum of |after - before| / sum of `before`, over all points and channels; empty without points
  /// or light.
  std::optional<double> mean;
  /// 95th percentile of the change: a point's sum over channels, relative to the mean point of
  /// `before`.
  std::optional<double> p95;
};

/// Computes the change of irradiance at the same points; four numbers each: red, green, blue and
/// one ignored. `counted` selects the points to include.
LightChange change_of_light(const std::vector<bool>& counted, const std::vector<float>& before,
                            const std::vector<float>& after);

/// Change from one frame to the next.
struct StabilityStep {
  int frame;  ///< the later one
  double seconds;
  bool still;                       ///< neither lights nor triangles changed
  std::vector<int> cascades_moved;  ///< by whole cells
  double seen;                      ///< share of the earlier frame's surfaces visible in this one
  LightChange change;
  std::optional<double> noise;  ///< mean change between two path-traced images, if requested
};

/// Measures consecutive frames. Gathers the light of each frame at the points visible in the
/// previous frame, which avoids interpolation between pixels. The near-field correction is taken
/// from the nearest pixel.
class Stability {
 public:
  /// `traced`: paths per pixel of the path-traced images; 0: none.
  Stability(Session& session, Frame& frame, std::uint32_t traced)
      : session_(session), frame_(frame), traced_(traced) {}

  /// Adds the last rendered frame, with the current state of `scene`.
  void add(int number, double seconds, const SceneData& scene, const SceneCamera& camera);
  const std::vector<StabilityStep>& steps() const { return steps_; }

 private:
  struct Seen {
    SurfaceImage surfaces;
    std::vector<float> irradiance;  ///< four per pixel
    std::vector<ClpvGrid> grids;
    std::uint64_t content;  ///< hash of lights and triangles
  };
  std::vector<float> light_before(const Seen& now);
  std::optional<double> noise(const SceneData& scene, const SceneCamera& camera,
                              const std::vector<bool>& counted) const;

  Session& session_;
  Frame& frame_;
  std::uint32_t traced_;
  std::optional<Seen> before_;
  std::vector<StabilityStep> steps_;
};

}  // namespace clpv
