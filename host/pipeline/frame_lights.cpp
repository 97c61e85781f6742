// SPDX-License-Identifier: MIT
#include "pipeline/frame_lights.hpp"

#include <algorithm>

#include "pipeline/frame_volumes.hpp"
#include "pipeline/light_scale.hpp"
#include "pipeline/view.hpp"

namespace clpv {

FrameLights::FrameLights(Session& session, const Scene& scene, const SceneBuffers& buffers,
                         Rasterizer& rasterizer, const RenderOptions& options)
    : session_(session), scene_(scene), buffers_(buffers), rasterizer_(rasterizer), options_(options) {}

/// Buffers are kept as long as the same lights shine.
void FrameLights::prepare(const Camera& camera, const std::vector<ClpvGrid>& grids, const MadeOf& triangles,
                          double other) {
  grids_ = grids;
  triangles_ = triangles;
  const std::vector<Light> shining = scene_.lights_for(camera);
  if (lights_.size() != shining.size() || lit_by_ != camera.light) lights_.clear();
  lit_by_ = camera.light;
  lights_.resize(shining.size());
  std::vector<ClpvLight> all;
  for (std::size_t i = 0; i < shining.size(); ++i) {
    const auto found = std::ranges::find(scene_.lights, shining[i].name, &Light::name);
    Lit& lit = lights_[i];
    lit.light = lit.shadow.light = shining[i].data;
    lit.index = static_cast<int>(found - scene_.lights.begin());
    lit.shadow.views = shadow_views(lit.light, buffers_.bounds, options_.shadow_size);
    lit.rsms.resize(static_cast<std::size_t>(injected_volumes(options_)));
    all.push_back(lit.light);
  }
  scale_ = light_scale(options_.format(), all, grids_.back().cell, other);
}

void FrameLights::rasterize_shadows() {
  const auto texels =
      static_cast<std::size_t>(options_.shadow_size) * static_cast<std::size_t>(options_.shadow_size);
  for (Lit& lit : lights_) {
    lit.shadow_kept.update(MadeOf().add(lit.shadow.views).add(triangles_), [&] {
      const StageScope scope(session_, {Pass::rasterize_shadow, {}, lit.index});
      lit.shadow.depths.resize(lit.shadow.views.size());
      for (std::size_t v = 0; v < lit.shadow.views.size(); ++v) {
        session_.reserve(lit.shadow.depths[v], texels * sizeof(float), "shadow map");
        rasterizer_.rasterize_shadow(lit.shadow.views[v], lit.shadow.depths[v]);
      }
    });
  }
}

/// Views that do not follow a cascade are the same for all of them.
std::size_t FrameLights::slot(const Lit& lit, int cascade) const {
  return rsm_follows_cascade(lit.light) && lit.rsms.size() > 1 ? static_cast<std::size_t>(cascade) : 0;
}

FrameLights::Wanted FrameLights::wanted_rsms(const Lit& lit, int cascade) const {
  Wanted wanted{
      rsm_views(lit.light, grids_[static_cast<std::size_t>(cascade)], buffers_.bounds, options_.rsm_size),
      {}};
  wanted.made_of.add(scaled(lit.light, scale_)).add(wanted.views).add(triangles_);
  return wanted;
}

void FrameLights::rasterize(const Lit& lit, const std::vector<ClpvView>& views,
                            std::vector<Surface>& surfaces) {
  surfaces.resize(views.size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (!surfaces[v].depth.exists())
      surfaces[v] = make_surface(session_, views[v], options_.rsm_format, false);
    surfaces[v].view = views[v];
    rasterizer_.rasterize_rsm(scaled(lit.light, scale_), surfaces[v]);
  }
}

void FrameLights::rasterize_rsms(int cascade) {
  for (Lit& lit : lights_) {
    const Wanted wanted = wanted_rsms(lit, cascade);
    Rsms& rsms = lit.rsms[slot(lit, cascade)];
    rsms.kept.update(wanted.made_of, [&] {
      const StageScope scope(session_, {Pass::rasterize_rsm, cascade, lit.index});
      rasterize(lit, wanted.views, rsms.surfaces);
    });
  }
}

MadeOf FrameLights::rsms_made_of(int cascade) const {
  MadeOf all;
  for (const Lit& lit : lights_) all.add(wanted_rsms(lit, cascade).made_of);
  return all;
}

std::vector<const Surface*> FrameLights::rsms(int cascade) const {
  std::vector<const Surface*> all;
  for (const Lit& lit : lights_) {
    for (const Surface& rsm : lit.rsms[slot(lit, cascade)].surfaces) all.push_back(&rsm);
  }
  return all;
}

std::vector<ShadowedLight> FrameLights::shadowed() const {
  std::vector<ShadowedLight> all;
  for (const Lit& lit : lights_) all.push_back(lit.shadow);
  return all;
}

void FrameLights::forget() {
  for (Lit& lit : lights_) {
    lit.shadow_kept.forget();
    for (Rsms& rsms : lit.rsms) rsms.kept.forget();
  }
}

}  // namespace clpv
