// SPDX-License-Identifier: MIT
#include "pipeline/frame/frame_cascades.hpp"

#include <algorithm>
#include <cmath>

#include "basis/bounce.hpp"
#include "kernels/shared/reflectors.h"
#include "pipeline/voxels/voxel_field.hpp"
#include "support/fingerprint.hpp"

namespace clpv {

FrameCascades::FrameCascades(Session& session, const SceneData& scene, const SceneBuffers& buffers,
                             const FrameSetup& setup, FrameLights& lights) try
    : session_(session),
      scene_(scene),
      buffers_(buffers),
      setup_(setup),
      options_(setup.options),
      lights_(lights),
      injector_(session, *setup.basis, inject_options(options_, setup.transport.unit_flux_lobes)),
      injected_(volumes(setup.injected_volumes(), setup.injected_shape(), "injected light",
                        setup.injects_at_once())),
      accumulated_(volumes(options_.cascades, setup.gathered_shape(), "accumulated light")),
      geometry_(volumes(setup.geometry_volumes(buffers.masked), setup.geometry_shape(),
                        "geometry volume")),
      links_(options_.cascades),
      surfaces_(options_.cascades),
      visible_cells_(options_.cascades),
      keys_(options_.cascades) {
  if (setup.sweeps()) {
    SweepOptions sweep = sweep_options(options_);
    sweep.medium = scene.medium;
    sweep.sky = scene.sky.get();
    sweep.blocking = !geometry_.empty();
    sweep.points = setup.links_by_points();
    sweeper_.emplace(session, *setup.basis, setup.transport, sweep);
  } else {
    propagator_.emplace(session, *setup.basis, setup.transport, propagate_options(options_));
  }
  if (!geometry_.empty() && !setup.blocked_by_view())
    blockers_.emplace(session, buffers,
                      blocker_masks(buffers, options_.grid, options_.cascades, options_.format(),
                                    setup.links_by_points()));
  const auto voxelise = [&](std::optional<VoxelField>& field, std::unique_ptr<Volume>& faces,
                            bool white) {
    field.emplace(session, buffers,
                  reflector_masks(buffers, options_.grid, options_.format(), white));
    faces = std::make_unique<Volume>(
        session, VolumeShape{options_.grid, kCellFaces, CLPV_REFLECTOR_CHANNELS}, "reflectors",
        options_.format());
  };
  if (sweeper_) voxelise(white_, white_faces_, true);
  if (options_.reflects()) voxelise(reflectors_, reflected_, false);
  if (options_.gather == Gathering::visible)
    visibility_.emplace(session, buffers, visibility_masks(options_.grid, options_.cascades));
} catch (const TooLarge& error) {
  throw Error(
      error.code(), "{}; grid: found {}, and at most {} can fit", error.what(), setup.options.grid,
      static_cast<int>(setup.options.grid *
                       std::cbrt(error.share)));  // their memory grows with the cube of the grid
}

std::vector<FrameCascades::CachedVolume> FrameCascades::volumes(int count, const VolumeShape& shape,
                                                                const char* what,
                                                                bool array) const {
  std::vector<CachedVolume> made(count);
  std::vector<Volume> together;
  if (array) together = Volume::array(session_, count, shape, what, options_.format());
  for (int i = 0; i < count; ++i)
    made[i].volume = array ? std::make_unique<Volume>(together[i])
                           : std::make_unique<Volume>(session_, shape, what, options_.format());
  return made;
}

FrameCascades::CachedVolume& FrameCascades::of_cascade(std::vector<CachedVolume>& volumes,
                                                       int cascade) {
  return volumes[std::min<std::size_t>(cascade, volumes.size() - 1)];
}

const Volume* FrameCascades::geometry(int cascade) {
  return geometry_.empty() ? nullptr : of_cascade(geometry_, cascade).volume.get();
}

void FrameCascades::prepare(const std::vector<ClpvGrid>& grids, const Surface* camera) {
  grids_ = grids;
  camera_ = camera;
  for (int cascade = options_.cascades; cascade-- > 0;) keys_[cascade] = keys_of(cascade);
}

FrameCascades::Keys FrameCascades::keys_of(int cascade) const {
  const ClpvGrid& grid = grids_[cascade];
  // The eye's position inside a cascade affects only gathering.
  const CacheKey place = Fingerprint().add(grid.origin).add(grid.cell).value();
  Keys keys;
  keys.triangles = Fingerprint().add(place).add(buffers_.clusters->instant()).value();
  keys.injected = Fingerprint()
                      .add(visibility_ && sweeper_ ? keys.triangles : place)
                      .add(lights_.sources_key(cascade))
                      .value();
  if (options_.blocked()) keys.geometry = keys.triangles;
  if (!geometry_.empty() && !blockers_)
    keys.geometry =
        Fingerprint().add(keys.triangles).add(lights_.rsms_key(cascade)).add(camera_->view).value();
  if (sweeper_) {
    Fingerprint surfaces;
    surfaces.add(keys.triangles).add(keys.geometry).add(sweeper_->halo(cascade, grids_));
    if (cascade + 1 < options_.cascades) surfaces.add(keys_[cascade + 1].surfaces);
    keys.surfaces = surfaces.value();
  }
  Fingerprint accumulated;
  accumulated.add(keys.injected).add(keys.geometry).add(keys.surfaces);
  // A sweep reads border light from the next coarser cascade, and stores the halo of the next finer
  // one.
  if (sweeper_)
    accumulated.add(sweeper_->halo(cascade, grids_)).add(scene_.sky ? lights_.scale() : 0.0f);
  if (sweeper_ && cascade + 1 < options_.cascades) accumulated.add(keys_[cascade + 1].accumulated);
  keys.accumulated = accumulated.value();
  return keys;
}

void FrameCascades::inject(int cascade) {
  CachedVolume& injected = of_cascade(injected_, cascade);
  injected.cached.update(keys_[cascade].injected, [&] {
    // A finer cascade moves whenever a coarser one does.
    const int first = setup_.injects_at_once() ? 0 : cascade;
    for (int c = first; c < cascade; ++c) injected_[c].cached.invalidate();
    inject_light(first, cascade);
    for (int c = first; c < cascade; ++c) injected_[c].cached.update(keys_[c].injected, [] {});
  });
}

/// Injects the light of the cascades from `first` to `last` by the same launches, source by source.
void FrameCascades::inject_light(int first, int last) {
  std::vector<std::vector<const Surface*>> sources;
  lights_.update_sources(first, last);
  Buffer occluded;
  if (visibility_ && sweeper_) {
    for (int c = first; c <= last; ++c) update_visibility(c);
    occluded = visibility_->masks();
  }
  for (int c = first; c <= last; ++c) sources.push_back(lights_.sources(c));
  const StageScope scope(session_,
                         {Pass::inject_light, first == last ? std::optional(first) : std::nullopt});
  of_cascade(injected_, first).volume->clear_to(session_, *of_cascade(injected_, last).volume);
  for (std::size_t i = 0; i < sources[0].size(); ++i) {
    std::vector<Injector::Target> targets;
    for (int c = first; c <= last; ++c)
      targets.push_back({*sources[c - first][i], grids_[c], *of_cascade(injected_, c).volume,
                         static_cast<cl_uint>(c)});
    injector_.inject_light(targets, occluded);
  }
}

void FrameCascades::update_blockers(int cascade) {
  if (geometry_.empty()) return;
  CachedVolume& geometry = of_cascade(geometry_, cascade);
  geometry.cached.update(keys_[cascade].geometry, [&] {
    if (!blockers_) return inject_geometry(cascade, *geometry.volume);
    const StageScope scope(session_, {Pass::blockers, cascade});
    blockers_->update(cascade, grids_[cascade], *geometry.volume);
  });
}

void FrameCascades::inject_geometry(int cascade, Volume& geometry) {
  lights_.rasterize_rsms(cascade, cascade);
  const StageScope scope(session_, {Pass::inject_geometry, cascade});
  geometry.clear(session_);
  for (const Surface* rsm : lights_.rsms(cascade))
    injector_.inject_geometry(*rsm, grids_[cascade], geometry);
  injector_.inject_geometry(*camera_, grids_[cascade], geometry, options_.blocker_stride);
}

void FrameCascades::update_links(int cascade) {
  if (!options_.blocked()) return;
  links_[cascade].update(keys_[cascade].geometry, [&] {
    const Buffer points = occluded(cascade);
    const StageScope scope(session_, {Pass::propagate, cascade});
    sweeper_->set_blockers(cascade, grids_, geometry(cascade), points);
  });
}

/// Bits of points that links see; an empty Buffer if links transmit by geometry volumes alone.
Buffer FrameCascades::occluded(int cascade) {
  if (!setup_.links_by_points()) return {};
  update_visibility(cascade);
  return visibility_->masks();
}

void FrameCascades::update_surfaces(int cascade) {
  if (!sweeper_) return;
  surfaces_[cascade].update(keys_[cascade].surfaces, [&] {
    const StageScope scope(session_, {Pass::reflectors, cascade});
    white_->update(cascade, grids_[cascade], *white_faces_);
    if (reflectors_) reflectors_->update(cascade, grids_[cascade], *reflected_);
    sweeper_->set_surfaces(cascade, grids_, *white_faces_, reflected_.get(),
                           *accumulated_[cascade].volume);
  });
}

void FrameCascades::update_visibility(int cascade) {
  if (!visibility_) return;
  visible_cells_[cascade].update(keys_[cascade].triangles, [&] {
    const StageScope scope(session_, {Pass::visibility, cascade});
    visibility_->update(cascade, grids_[cascade]);
  });
}

void FrameCascades::propagate(int cascade) {
  CachedVolume& accumulated = accumulated_[cascade];
  accumulated.cached.update(keys_[cascade].accumulated, [&] {
    inject(cascade);
    update_blockers(cascade);
    if (sweeper_) update_links(cascade);
    update_surfaces(cascade);
    const Volume& injected = *of_cascade(injected_, cascade).volume;
    const StageScope scope(session_, {Pass::propagate, cascade});
    if (propagator_)
      return propagator_->propagate({injected, geometry(cascade), *accumulated.volume},
                                    options_.iterations);
    SweepInput input{static_cast<std::size_t>(cascade), grids_, injected, lights_.scale()};
    if (scene_.medium) input.lights = scaled(lights_.shadowed(), lights_.scale());
    sweeper_->sweep(input, *accumulated.volume);
  });
}

void FrameCascades::update(int cascade, const CascadeObserver& observer) {
  propagate(cascade);
  update_visibility(cascade);
  if (!observer) return;
  inject(cascade);  // a shared volume may hold another cascade
  update_blockers(cascade);
  observer({cascade, grids_[cascade], *of_cascade(injected_, cascade).volume, geometry(cascade),
            *accumulated_[cascade].volume, lights_.scale()});
}

GatheredLight FrameCascades::light() const {
  GatheredLight light{.grids = grids_, .accumulated = {}, .scale = lights_.scale()};
  if (visibility_) light.occluded = visibility_->masks();
  for (std::size_t c = 0; c < accumulated_.size(); ++c) {
    light.accumulated.push_back(accumulated_[c].volume.get());
    light.keys.push_back(Fingerprint().add(keys_[c].accumulated).add(light.scale).value());
  }
  return light;
}

}  // namespace clpv
