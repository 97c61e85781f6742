// SPDX-License-Identifier: MIT
// Lights of a frame: caches shadow maps, reflective shadow maps (RSMs) and points on emissive
// surfaces until light, view or scene change.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "kernels/shared/light.h"
#include "pipeline/frame/cached.hpp"
#include "pipeline/frame/frame_emission.hpp"
#include "pipeline/frame/frame_setup.hpp"
#include "pipeline/raster/rasterize.hpp"
#include "pipeline/raster/scene_buffers.hpp"
#include "pipeline/raster/shadow_maps.hpp"
#include "pipeline/raster/surface.hpp"
#include "pipeline/raster/view.hpp"
#include "scene/scene.hpp"
#include "scene/sky.hpp"
#include "volume/volume_format.hpp"

namespace clpv {

class FrameLights {
 public:
  /// All arguments must outlive this object. `buffers` hold `scene` at its current time.
  FrameLights(Session& session, const SceneData& scene, const SceneBuffers& buffers,
              Rasterizer& rasterizer, const FrameSetup& setup);

  /// Prepares the lights of `camera` at the scene's current time, for cascades at `grids`.
  void prepare(const SceneCamera& camera, const std::vector<ClpvGrid>& grids);

  /// Update the shadow maps, the RSMs of the cascades from `first` to `last`, or these RSMs and the
  /// points on emissive surfaces.
  void rasterize_shadows();
  void rasterize_rsms(int first, int last);
  void update_sources(int first, int last);

  /// RSMs of a cascade from rasterize_rsms(); valid until its next call for another cascade.
  CacheKey rsms_key(int cascade) const;
  std::vector<const Surface*> rsms(int cascade);

  /// Key of all light injected into a cascade: RSMs and points on emissive surfaces.
  CacheKey sources_key(int cascade) const;
  std::vector<const Surface*> sources(int cascade);

  /// Shadow maps from rasterize_shadows().
  std::vector<ShadowedLight> shadowed() const;

  /// Value that RSMs and volumes store for 1 W/sr.
  float scale() const { return scale_; }

  /// Makes the next frame recompute all lighting.
  void invalidate() { ++epoch_; }

 private:
  struct Rsms {  ///< one or six views
    std::vector<Surface> surfaces;
    Cached cached;
  };
  struct Wanted {  ///< RSMs that a cascade needs
    std::vector<ClpvView> views;
    CacheKey key;
  };
  struct Lit {  ///< a light and its maps
    ClpvLight light;
    int index;                   ///< index in SceneData::lights
    std::vector<Rsms> rsms;      ///< one per cascade, or one shared by all or in turn
    std::vector<Wanted> wanted;  ///< one per cascade
    ShadowedLight shadow;
    Cached shadow_cached;
  };
  static Rsms& of_cascade(Lit& lit, int cascade);
  void find_lights(const SceneCamera& camera);
  void find_scale(const ClpvGrid& coarsest);
  void find_bounds(const ClpvGrid& coarsest);
  CacheKey key_of(const ClpvLight& light, const std::vector<ClpvView>& views) const;
  void place_rsms();
  void forget_rsms();

  Session& session_;
  const SceneData& scene_;
  const SceneBuffers& buffers_;
  Rasterizer& rasterizer_;
  const FrameSetup& setup_;
  const RenderOptions& options_;
  std::optional<FrameEmission> emission_;  ///< none without emissive surfaces
  float brightest_sky_;                    ///< [W/m^2/sr]
  std::vector<Lit> lights_;
  std::string lit_by_;  ///< Camera::light for which lights_ were prepared
  float scale_ = 1;
  LightBounds bounds_;  ///< at the scene's current time
  Cached bounds_cached_;
  unsigned epoch_ = 0;  ///< part of every key
};

/// Returns the scale of stored light: a power of two for 16-bit storage, 1 for float32. 16-bit
/// numbers end at 65504 and lose precision below 6e-5, while lights may be given in lux. With this
/// scale, a cell of `coarsest_cell` [m] that receives all light of the brightest source stores
/// about 256 W/sr. Cells of each finer cascade store a quarter of it. This leaves room for light
/// that propagation adds, and for values a million times smaller. `other`: upper bound of the flux
/// that all other sources send through such a cell [W] (max_emitted_flux).
float light_scale(const VolumeFormat& format, const std::vector<ClpvLight>& lights,
                  float coarsest_cell, double other = 0);

}  // namespace clpv
