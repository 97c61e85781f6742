// SPDX-License-Identifier: MIT
#include "pipeline/frame/frame_lights.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/raster/view.hpp"
#include "support/fingerprint.hpp"

namespace clpv {
namespace {

constexpr double kFull = 256;        // [W/sr] stored in a full cell
constexpr double kMaxDoubling = 60;  // for a light so weak that float32 would overflow

/// Returns the upper bound of the flux that a light sends through a cell [W].
double max_flux(const ClpvLight& light, double cell) {
  const double brightest = *std::max_element(light.intensity, light.intensity + 3);
  return brightest * (rsm_follows_cascade(light) ? cell * cell : 4 * std::numbers::pi);
}

}  // namespace

FrameLights::FrameLights(Session& session, const SceneData& scene, const SceneBuffers& buffers,
                         Rasterizer& rasterizer, const FrameSetup& setup)
    : session_(session),
      scene_(scene),
      buffers_(buffers),
      rasterizer_(rasterizer),
      setup_(setup),
      options_(setup.options),
      brightest_sky_(scene.sky ? scene.sky->max_radiance() : 0) {
  if (emits(scene)) emission_.emplace(session, scene, buffers);
}

void FrameLights::prepare(const SceneCamera& camera, const std::vector<ClpvGrid>& grids) {
  find_lights(camera);
  find_scale(grids.back());
  find_bounds(grids.back());
  for (Lit& lit : lights_) {
    const LightBounds bounds =
        rsm_follows_cascade(lit.light) ? bounds_ : LightBounds{buffers_.bounds, buffers_.bounds};
    lit.shadow.light = lit.light;
    lit.shadow.views = shadow_views(lit.light, bounds.shadows, options_.shadow_size);
    lit.rsms.resize(rsm_follows_cascade(lit.light) ? setup_.injected_volumes() : 1);
    lit.wanted.clear();
    for (const ClpvGrid& grid : grids) {
      std::vector<ClpvView> views = rsm_views(lit.light, grid, bounds.rsms, options_.rsm_size);
      const CacheKey key = key_of(scaled(lit.light, scale_), views);
      lit.wanted.push_back({std::move(views), key});
    }
  }
  place_rsms();
  if (emission_) emission_->prepare(grids, scale_, epoch_);
}

/// Keeps the buffers while the set of lights is unchanged.
void FrameLights::find_lights(const SceneCamera& camera) {
  const std::vector<SceneLight> shining = scene_.lights_for(camera);
  if (lights_.size() != shining.size() || lit_by_ != camera.light) lights_.clear();
  lit_by_ = camera.light;
  lights_.resize(shining.size());
  for (std::size_t i = 0; i < shining.size(); ++i) {
    const auto found = std::ranges::find(scene_.lights, shining[i].name, &SceneLight::name);
    lights_[i].light = shining[i].data;
    lights_[i].index = found - scene_.lights.begin();
  }
}

void FrameLights::find_scale(const ClpvGrid& coarsest) {
  const double cell = double{coarsest.cell};
  double other = emission_ ? emission_->max_flux(cell) : 0;
  other += std::numbers::pi * double{brightest_sky_} * cell * cell;
  std::vector<ClpvLight> all;
  for (const Lit& lit : lights_) all.push_back(lit.light);
  scale_ = light_scale(options_.format(), all, coarsest.cell, other);
}

void FrameLights::find_bounds(const ClpvGrid& coarsest) {
  const CacheKey key = Fingerprint()
                           .add(coarsest.origin)
                           .add(coarsest.cell)
                           .add(buffers_.clusters->instant())
                           .value();
  bounds_cached_.update(
      key, [&] { bounds_ = light_bounds(scene_.vertices, buffers_.bounds, coarsest); });
}

CacheKey FrameLights::key_of(const ClpvLight& light, const std::vector<ClpvView>& views) const {
  return Fingerprint().add(light).add(views).add(buffers_.clusters->instant()).add(epoch_).value();
}

void FrameLights::rasterize_shadows() {
  const std::size_t texels = std::size_t(options_.shadow_size) * options_.shadow_size;
  for (Lit& lit : lights_) {
    // Shadow maps depend only on the views, not on intensity.
    lit.shadow_cached.update(key_of({}, lit.shadow.views), [&] {
      const StageScope scope(session_, {Pass::rasterize_shadow, {}, lit.index});
      session_.reserve(lit.shadow.view_table, lit.shadow.views.size() * sizeof(ClpvView),
                       "views of a light");
      session_.write(lit.shadow.view_table, lit.shadow.views);
      lit.shadow.depths.resize(lit.shadow.views.size());
      for (std::size_t v = 0; v < lit.shadow.views.size(); ++v) {
        session_.reserve(lit.shadow.depths[v], texels * sizeof(float), "shadow map");
        rasterizer_.rasterize_shadow(lit.shadow.views[v], lit.shadow.depths[v]);
      }
    });
  }
}

/// Gives each RSM its place in memory that many share, since the same launches draw those.
void FrameLights::place_rsms() {
  std::vector<Surface*> all;
  for (Lit& lit : lights_) {
    for (Rsms& rsms : lit.rsms) {
      rsms.surfaces.resize(lit.wanted[0].views.size());
      for (Surface& surface : rsms.surfaces) all.push_back(&surface);
    }
  }
  if (std::ranges::all_of(all, [](const Surface* s) { return s->depth.exists(); })) return;
  forget_rsms();
  for (Surface* surface : all) *surface = {};  // first: memory may not suffice for both
  ClpvView view{};
  view.width = view.height = options_.rsm_size;
  const std::size_t most = setup_.rsms_together();
  Surface together;
  std::size_t used = most, left = all.size();
  for (Lit& lit : lights_) {
    // The same launches inject a light's maps of all cascades, from the same memory.
    if (lit.rsms.size() > 1 && used + lit.rsms.size() * lit.wanted[0].views.size() > most)
      used = most;
    for (Rsms& rsms : lit.rsms) {
      for (Surface& surface : rsms.surfaces) {
        if (used == most) {
          together = make_surface(session_, view, options_.rsm_format, false,
                                  static_cast<int>(std::min(most, left)));
          used = 0;
        }
        surface = together;
        surface.first = used * view.width * view.height;
        ++used, --left;
      }
    }
  }
}

void FrameLights::forget_rsms() {
  for (Lit& lit : lights_)
    for (Rsms& rsms : lit.rsms) rsms.cached.invalidate();
}

FrameLights::Rsms& FrameLights::of_cascade(Lit& lit, int cascade) {
  return lit.rsms[std::min<std::size_t>(cascade, lit.rsms.size() - 1)];
}

void FrameLights::rasterize_rsms(int first, int last) {
  std::vector<Rasterizer::Rsm> stale;
  for (Lit& lit : lights_) {
    for (int cascade = first; cascade <= last; ++cascade) {
      Rsms& rsms = of_cascade(lit, cascade);
      rsms.cached.update(lit.wanted[cascade].key, [&] {
        for (std::size_t v = 0; v < rsms.surfaces.size(); ++v) {
          rsms.surfaces[v].view = lit.wanted[cascade].views[v];
          stale.push_back({scaled(lit.light, scale_), &rsms.surfaces[v]});
        }
      });
    }
  }
  if (stale.empty()) return;
  const StageScope scope(
      session_, {Pass::rasterize_rsm, first == last ? std::optional(first) : std::nullopt});
  try {
    rasterizer_.rasterize_rsms(stale);
  } catch (...) {
    forget_rsms();
    throw;
  }
}

void FrameLights::update_sources(int first, int last) {
  rasterize_rsms(first, last);
  if (emission_) emission_->emit();
}

CacheKey FrameLights::rsms_key(int cascade) const {
  Fingerprint all;
  for (const Lit& lit : lights_) all.add(lit.wanted[cascade].key);
  return all.value();
}

CacheKey FrameLights::sources_key(int cascade) const {
  return Fingerprint().add(rsms_key(cascade)).add(emission_ ? emission_->key() : 0).value();
}

std::vector<const Surface*> FrameLights::rsms(int cascade) {
  std::vector<const Surface*> all;
  for (Lit& lit : lights_) {
    for (const Surface& rsm : of_cascade(lit, cascade).surfaces) all.push_back(&rsm);
  }
  return all;
}

std::vector<const Surface*> FrameLights::sources(int cascade) {
  std::vector<const Surface*> all = rsms(cascade);
  if (emission_) all.push_back(&emission_->points());
  return all;
}

std::vector<ShadowedLight> FrameLights::shadowed() const {
  std::vector<ShadowedLight> all;
  for (const Lit& lit : lights_) all.push_back(lit.shadow);
  return all;
}

float light_scale(const VolumeFormat& format, const std::vector<ClpvLight>& lights,
                  float coarsest_cell, double other) {
  double flux = other;
  for (const ClpvLight& light : lights) flux += max_flux(light, static_cast<double>(coarsest_cell));
  if (format.storage != Storage::float16 || !(flux > 0)) return 1;
  const double doublings = std::floor(std::log2(kFull * std::numbers::pi / flux));
  return std::exp2(std::clamp(doublings, -kMaxDoubling, kMaxDoubling));
}

}  // namespace clpv
