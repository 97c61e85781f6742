// SPDX-License-Identifier: MIT
// How steady light is along a sequence: its change on surfaces that stay, from each frame to the next.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "device/session.hpp"
#include "evaluate/stability.hpp"
#include "pipeline/frame.hpp"

namespace clpv {

/// Takes frames one after the other. Of each but the first it looks at the surfaces that the frame before saw and that this one
/// sees too, and holds the light that this frame's volumes put there against that of the frame before: the same points, so
/// that nothing is interpolated between pixels.
class SequenceStability {
 public:
  /// `traced`: paths a pixel by which path tracing puts light there, twice; 0: it does not.
  SequenceStability(Session& session, Frame& frame, std::uint32_t traced)
      : session_(session), frame_(frame), traced_(traced) {}

  /// The frame rendered last, of `scene` as it is now.
  void add(int number, double seconds, const Scene& scene, const Camera& camera);

  /// Schema 1: all that `about` has; frames; and a summary of those before which neither lights nor triangles changed, by
  /// whether a cascade moved.
  nlohmann::json to_json(const nlohmann::json& about) const;

 private:
  struct Seen {
    SurfaceImage surfaces;
    std::vector<float> irradiance;  ///< four a pixel
    std::vector<ClpvGrid> grids;
    std::uint64_t content;  ///< of lights and triangles
  };
  struct Step {
    int frame;
    double seconds;
    bool still;              ///< neither lights nor triangles changed
    std::vector<int> moved;  ///< cascades
    double seen;             ///< share of the surfaces of the frame before
    LightChange change;
    std::optional<double> noise;  ///< by path tracing
  };
  Step step(int number, double seconds, const Seen& now, const Scene& scene, const Camera& camera);
  /// Two path-traced images of the surfaces of the frame before, under the light of now, one against the other.
  std::optional<double> noise_of(const Scene& scene, const Camera& camera,
                                 const std::vector<bool>& counted) const;

  Session& session_;
  Frame& frame_;
  std::uint32_t traced_;
  std::optional<Seen> before_;
  std::vector<Step> steps_;
};

}  // namespace clpv
