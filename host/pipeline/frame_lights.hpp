// SPDX-License-Identifier: MIT
// The lights that shine on a frame, and what is rasterised for them: shadow maps and reflective shadow maps (RSMs), each
// kept while light, view and scene stay as they are.
#pragma once

#include <string>
#include <vector>

#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "options/render_options.hpp"
#include "pipeline/made_of.hpp"
#include "pipeline/rasterize.hpp"
#include "pipeline/scene_buffers.hpp"
#include "pipeline/shade.hpp"
#include "pipeline/surface.hpp"
#include "scene/scene.hpp"

namespace clpv {

class FrameLights {
 public:
  /// All must stay as long as this does. `buffers`: of `scene`, at the instant it shows.
  FrameLights(Session& session, const Scene& scene, const SceneBuffers& buffers, Rasterizer& rasterizer,
              const RenderOptions& options);

  /// The lights that shine with `camera`, as the scene has them now, over cascades that stand at `grids`. `triangles`: what
  /// the scene's are made of now; `other`: the most light that is none of theirs, as light_scale() wants it.
  void prepare(const Camera& camera, const std::vector<ClpvGrid>& grids, const MadeOf& triangles,
               double other = 0);

  /// Brings to date the shadow maps, or the RSMs that light a cascade.
  void rasterize_shadows();
  void rasterize_rsms(int cascade);

  /// Of a cascade's RSMs. As rasterize_rsms() left them, until it is called for another cascade.
  MadeOf rsms_made_of(int cascade) const;
  std::vector<const Surface*> rsms(int cascade) const;

  /// As rasterize_shadows() left them.
  std::vector<ShadowedLight> shadowed() const;

  /// What RSMs and volumes hold in place of 1 W/sr.
  float scale() const { return scale_; }

  /// Next time all is made anew.
  void forget();

 private:
  struct Rsms {  ///< a view each: one, or six
    std::vector<Surface> surfaces;
    Kept kept;
  };
  struct Lit {  ///< a light and what is rasterised for it
    ClpvLight light;
    int index;               ///< in Scene::lights
    std::vector<Rsms> rsms;  ///< of all cascades, or those of one in turn
    ShadowedLight shadow;
    Kept shadow_kept;
  };
  struct Wanted {
    std::vector<ClpvView> views;
    MadeOf made_of;
  };
  std::size_t slot(const Lit& lit, int cascade) const;
  Wanted wanted_rsms(const Lit& lit, int cascade) const;
  void rasterize(const Lit& lit, const std::vector<ClpvView>& views, std::vector<Surface>& surfaces);

  Session& session_;
  const Scene& scene_;
  const SceneBuffers& buffers_;
  Rasterizer& rasterizer_;
  const RenderOptions& options_;
  std::vector<Lit> lights_;
  std::string lit_by_;  ///< Camera::light that lights_ were prepared for
  std::vector<ClpvGrid> grids_;
  MadeOf triangles_;
  float scale_ = 1;
};

}  // namespace clpv
