// SPDX-License-Identifier: MIT
// The lights that shine on a frame, and what is computed for them alone: shadow maps, reflective shadow maps (RSMs) and
// points on emissive surfaces, each cached while light, view and scene stay as they are.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "kernels/shared/light.h"
#include "options/render_options.hpp"
#include "pipeline/cached.hpp"
#include "pipeline/frame_emission.hpp"
#include "pipeline/rasterize.hpp"
#include "pipeline/scene_buffers.hpp"
#include "pipeline/shade.hpp"
#include "pipeline/surface.hpp"
#include "scene/scene.hpp"
#include "scene/sky.hpp"
#include "volume/volume_format.hpp"

namespace clpv {

class FrameLights {
 public:
  /// All must stay as long as this does. `buffers`: of `scene`, at the instant it shows.
  FrameLights(Session& session, const Scene& scene, const SceneBuffers& buffers, Rasterizer& rasterizer,
              const RenderOptions& options);

  /// The lights that shine with `camera`, as the scene has them now, over cascades that stand at `grids`.
  void prepare(const Camera& camera, const std::vector<ClpvGrid>& grids);

  /// Bring to date the shadow maps, the RSMs that light a cascade, or these and the points on emissive surfaces.
  void rasterize_shadows();
  void rasterize_rsms(int cascade);
  void update_sources(int cascade);

  /// Of a cascade's RSMs, as rasterize_rsms() left them, until it is called for another cascade.
  CacheKey rsms_key(int cascade) const;
  std::vector<const Surface*> rsms(int cascade) const;

  /// Of all that injects light into a cascade: its RSMs, and points on emissive surfaces.
  CacheKey sources_key(int cascade) const;
  std::vector<const Surface*> sources(int cascade) const;

  /// As rasterize_shadows() left them.
  std::vector<ShadowedLight> shadowed() const;

  /// What RSMs and volumes hold in place of 1 W/sr.
  float scale() const { return scale_; }

  /// The next frame computes all of it again.
  void invalidate() { ++epoch_; }

 private:
  struct Rsms {  ///< a view each: one, or six
    std::vector<Surface> surfaces;
    Cached cached;
  };
  struct Wanted {  ///< RSMs of a cascade
    std::vector<ClpvView> views;
    CacheKey key;
  };
  struct Lit {  ///< a light and what is rasterised for it
    ClpvLight light;
    int index;                   ///< in Scene::lights
    std::vector<Rsms> rsms;      ///< of all cascades, or those of one in turn
    std::vector<Wanted> wanted;  ///< a cascade
    ShadowedLight shadow;
    Cached shadow_cached;
  };
  /// Views that do not follow a cascade are the same for all of them.
  static std::size_t slot(const Lit& lit, int cascade);
  void find_lights(const Camera& camera);
  void find_scale(const ClpvGrid& coarsest);
  CacheKey key_of(const ClpvLight& light, const std::vector<ClpvView>& views) const;
  void rasterize(const Lit& lit, const std::vector<ClpvView>& views, std::vector<Surface>& surfaces);

  Session& session_;
  const Scene& scene_;
  const SceneBuffers& buffers_;
  Rasterizer& rasterizer_;
  const RenderOptions& options_;
  std::optional<FrameEmission> emission_;  ///< none: no surface emits
  float brightest_sky_;                    ///< [W/m^2/sr]
  std::vector<Lit> lights_;
  std::string lit_by_;  ///< Camera::light that lights_ were prepared for
  float scale_ = 1;
  unsigned epoch_ = 0;  ///< part of every key
};

/// A power of two; 1 for floats. Numbers of 16 bits end at 65504, lose digits below 6e-5, and lights may be given in lux:
/// scaled, a cell of `coarsest_cell` [m] that holds all that the brightest light can send it has some 256 W/sr. Finer
/// cascades hold a quarter each; what steps add stays below the end, and a million times less still has its digits.
/// `other`: the most that all else sends through such a cell [W] (max_emitted_flux).
float light_scale(const VolumeFormat& format, const std::vector<ClpvLight>& lights, float coarsest_cell,
                  double other = 0);

/// The light, so many times as bright.
ClpvLight scaled(ClpvLight light, float scale);

}  // namespace clpv
