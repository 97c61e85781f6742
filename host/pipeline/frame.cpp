// SPDX-License-Identifier: MIT
#include "pipeline/frame.hpp"

#include <algorithm>
#include <numbers>

#include "basis/sweep.hpp"
#include "pipeline/frame_volumes.hpp"
#include "pipeline/sky_background.hpp"
#include "pipeline/view.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"

namespace clpv {
namespace {

/// Where a cascade stands. Where in it the eye is matters to gathering alone.
MadeOf place_of(const ClpvGrid& grid) {
  return MadeOf().add(grid.origin).add(grid.cell);
}

/// Steps carry no light from beyond the cascades.
void require_sweep(const RenderOptions& options, const Scene& scene) {
  if (!scene.sky || options.transport == TransportKind::sweep) return;
  throw Error(ExitCode::usage, "transport: found '{}' with a sky, allowed: sweep (or a scene without a sky)",
              name_of(options.transport));
}

/// A sky is brighter outside walls than what is behind them by so much that what leaks along diagonal ways is most there.
constexpr double kClosedUnderASky = 0.75;

Transport transport_for(const RenderOptions& options, const Basis& basis, const Scene& scene) {
  Transport transport = make_transport(options, basis);
  if (scene.sky && options.transport == TransportKind::sweep)
    close_diagonals(std::get<std::vector<SweepWay>>(transport.scheme), kClosedUnderASky);
  return transport;
}

/// What a scene's triangles are, as far as they can change.
MadeOf triangles_of(const Scene& scene) {
  Fingerprint print;
  add_moving(print, scene);
  return MadeOf().add(print.value());
}

}  // namespace

Frame::Frame(Session& session, const Scene& scene, const RenderOptions& options)
    : session_(session),
      scene_(scene),
      basis_(make_basis(options)),
      swept_(swept_basis(options)),
      options_(checked(session, options, *basis_)),
      transport_(transport_for(options, *basis_, scene)),
      buffers_(upload_scene(session, scene)),
      rasterizer_(session, buffers_),
      injector_(session, *basis_, inject_options(options, transport_.unit_flux_lobes)),
      gatherer_(session, gathered(), options.transport, gather_options(options)),
      shader_(session),
      lights_(session, scene, buffers_, rasterizer_, options_),
      triangles_(triangles_of(scene)),
      injected_(volumes(injected_volumes(options), light_shape(options, *basis_), "injected light")),
      accumulated_(volumes(options.cascades, light_shape(options, gathered()), "accumulated light")),
      geometry_(volumes(geometry_volumes(options), geometry_shape(options, *basis_), "geometry volume")),
      ways_(accumulated_.size()),
      seen_(accumulated_.size()),
      reflected_(accumulated_.size()),
      packed_(accumulated_.size()),
      brightest_sky_(scene.sky ? scene.sky->brightest() : 0) {
  require_sweep(options, scene);
  if (emits(scene)) emission_.emplace(session, scene, buffers_);
  if (swept_) {
    sweeper_.emplace(session, *basis_, transport_, sweep_options(options));
    if (scene.sky) sweeper_->let_in(*scene.sky);
  } else {
    propagator_.emplace(session, *basis_, transport_, propagate_options(options));
  }
  if (!geometry_.empty() && !blocked_by_view(options))
    blocker_.emplace(session, buffers_, options.grid, options.cascades, options.format());
  if (options.bounces != Bounces::one)
    reflector_.emplace(session, buffers_, options.grid, options.cascades, options.format());
  if (options.gather == Gathering::visible) sight_.emplace(session, buffers_, options.grid, options.cascades);
  const auto pixels = static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
  irradiance_ = session.buffer(pixels * 4 * sizeof(float), "irradiance");
  image_ = session.buffer(pixels * 4 * sizeof(float), "shaded image");
  session.build_described();
}

std::vector<Frame::KeptVolume> Frame::volumes(int count, const VolumeShape& shape, const char* what) const {
  std::vector<KeptVolume> made;
  for (int i = 0; i < count; ++i)
    made.push_back({std::make_unique<Volume>(session_, shape, what, options_.format()), {}});
  return made;
}

Frame::KeptVolume& Frame::of_cascade(std::vector<KeptVolume>& volumes, int cascade) {
  return volumes[std::min(static_cast<std::size_t>(cascade), volumes.size() - 1)];
}

void Frame::scene_moved() {
  const MadeOf triangles = triangles_of(scene_);
  if (triangles == triangles_) return;
  upload_moving(session_, scene_, buffers_);
  triangles_ = triangles;
}

void Frame::forget_light() {
  lights_.forget();
  if (emission_) emission_->forget();
  for (KeptVolume& injected : injected_) injected.kept.forget();
  for (KeptVolume& accumulated : accumulated_) accumulated.kept.forget();
  for (Kept& packed : packed_) packed.forget();
  if (blocker_) return;
  for (KeptVolume& geometry : geometry_) geometry.kept.forget();
  for (Kept& ways : ways_) ways.forget();
}

void Frame::forget() {
  forget_light();
  if (blocker_) blocker_->forget();
  if (reflector_) reflector_->forget();
  if (sight_) sight_->forget();
  for (KeptVolume& geometry : geometry_) geometry.kept.forget();
  for (Kept& ways : ways_) ways.forget();
  for (Kept& reflected : reflected_) reflected.forget();
  for (Kept& seen : seen_) seen.forget();
}

MadeOf Frame::injected_made_of(int cascade) const {
  MadeOf made_of = MadeOf().add(place_of(grid(cascade))).add(lights_.rsms_made_of(cascade));
  if (emission_) made_of.add(emission_->made_of());
  return made_of;
}

MadeOf Frame::geometry_made_of(int cascade) const {
  MadeOf made_of = MadeOf().add(place_of(grid(cascade))).add(triangles_);
  if (!blocker_) made_of.add(lights_.rsms_made_of(cascade)).add(camera_surface_->view);
  return made_of;
}

/// What is sent back in all bounces depends on what blocks.
MadeOf Frame::reflected_made_of(int cascade) const {
  MadeOf made_of = MadeOf().add(place_of(grid(cascade))).add(triangles_);
  if (!geometry_.empty()) made_of.add(geometry_made_of(cascade));
  return made_of;
}

/// A sweep takes what comes in at a cascade's border from the next coarser one, and keeps what the next finer one will take.
MadeOf Frame::accumulated_made_of(int cascade) const {
  MadeOf made_of = injected_made_of(cascade);
  if (!geometry_.empty()) made_of.add(geometry_made_of(cascade));
  if (!sweeper_) return made_of;
  if (scene_.sky) made_of.add(lights_.scale());
  if (reflector_) made_of.add(reflected_made_of(cascade));
  made_of.add(sweeper_->shell(static_cast<std::size_t>(cascade), grids_));
  if (cascade + 1 < options_.cascades) made_of.add(accumulated_made_of(cascade + 1));
  return made_of;
}

void Frame::prepare_light(const Camera& camera) {
  const double cell = double{grids_.back().cell};
  double other = emission_ ? emission_->most(cell, triangles_) : 0;
  if (scene_.sky) other += std::numbers::pi * double{brightest_sky_} * cell * cell;
  lights_.prepare(camera, grids_, triangles_, other);
  if (emission_) emission_->prepare(grids_, triangles_, lights_.scale());
  if (scene_.sky) sweeper_->scale_sky(lights_.scale());
}

void Frame::rasterize_camera(const Camera& camera) {
  const StageScope scope(session_, {Pass::rasterize_camera});
  const ClpvView view = camera_view(camera, options_.width, options_.height);
  if (!camera_surface_) camera_surface_ = make_surface(session_, view, RsmFormat::float32, buffers_.emissive);
  camera_surface_->view = view;
  rasterizer_.rasterize_camera(*camera_surface_);
}

void Frame::inject(int cascade) {
  KeptVolume& injected = of_cascade(injected_, cascade);
  injected.kept.update(injected_made_of(cascade), [&] {
    lights_.rasterize_rsms(cascade);
    if (emission_) emission_->emit();
    const StageScope scope(session_, {Pass::inject_light, cascade});
    injected.volume->clear(session_);
    for (const Surface* rsm : lights_.rsms(cascade))
      injector_.inject_light(*rsm, grid(cascade), *injected.volume);
    if (emission_) injector_.inject_light(emission_->points(), grid(cascade), *injected.volume);
  });
}

void Frame::block(int cascade) {
  KeptVolume& geometry = of_cascade(geometry_, cascade);
  geometry.kept.update(geometry_made_of(cascade), [&] {
    if (!blocker_) return inject_geometry(cascade, *geometry.volume);
    const StageScope scope(session_, {Pass::block, cascade});
    blocker_->block(static_cast<std::size_t>(cascade), grid(cascade), *geometry.volume);
  });
}

void Frame::inject_geometry(int cascade, Volume& geometry) {
  lights_.rasterize_rsms(cascade);
  const StageScope scope(session_, {Pass::inject_geometry, cascade});
  geometry.clear(session_);
  for (const Surface* rsm : lights_.rsms(cascade)) injector_.inject_geometry(*rsm, grid(cascade), geometry);
  injector_.inject_geometry(*camera_surface_, grid(cascade), geometry, options_.blocker_stride);
}

void Frame::let_through(int cascade) {
  if (geometry_.empty()) return;
  const auto c = static_cast<std::size_t>(cascade);
  ways_[c].update(geometry_made_of(cascade),
                  [&] { sweeper_->block(c, *of_cascade(geometry_, cascade).volume); });
}

void Frame::reflect(int cascade) {
  const auto c = static_cast<std::size_t>(cascade);
  reflected_[c].update(reflected_made_of(cascade), [&] {
    const StageScope scope(session_, {Pass::reflect, cascade});
    let_through(cascade);
    reflector_->reflect(c, grid(cascade));
    sweeper_->reflect(c, reflector_->reflectors(c));
  });
}

void Frame::see(int cascade) {
  if (!sight_) return;
  const auto c = static_cast<std::size_t>(cascade);
  seen_[c].update(MadeOf().add(place_of(grid(cascade))).add(triangles_), [&] {
    const StageScope scope(session_, {Pass::see, cascade});
    sight_->see(c, grid(cascade));
  });
}

void Frame::propagate(int cascade) {
  const auto c = static_cast<std::size_t>(cascade);
  KeptVolume& accumulated = accumulated_[c];
  accumulated.kept.update(accumulated_made_of(cascade), [&] {
    inject(cascade);
    if (!geometry_.empty()) block(cascade);
    const Volume& injected = *of_cascade(injected_, cascade).volume;
    const Volume* geometry = geometry_.empty() ? nullptr : of_cascade(geometry_, cascade).volume.get();
    if (reflector_) reflect(cascade);
    const StageScope scope(session_, {Pass::propagate, cascade});
    if (propagator_)
      return propagator_->propagate({injected, geometry, *accumulated.volume}, options_.iterations);
    let_through(cascade);
    sweeper_->sweep(c, grids_, injected, *accumulated.volume);
  });
}

void Frame::light_cascade(int cascade, const CascadeObserver& observer) {
  propagate(cascade);
  see(cascade);
  if (!observer) return;
  inject(cascade);  // what cascades share may hold another one's
  if (!geometry_.empty()) block(cascade);
  observer({cascade, grid(cascade), *of_cascade(injected_, cascade).volume,
            geometry_.empty() ? nullptr : of_cascade(geometry_, cascade).volume.get(),
            *accumulated_[static_cast<std::size_t>(cascade)].volume, lights_.scale()});
}

void Frame::gather(const Surface& surface, Buffer& irradiance) {
  const GatheredLight gathered = light();
  std::vector<bool> changed(packed_.size(), false);
  for (std::size_t c = 0; c < changed.size(); ++c)
    packed_[c].update(accumulated_made_of(static_cast<int>(c)), [&] { changed[c] = true; });
  gatherer_.gather(surface, gathered.grids, gathered.accumulated, irradiance, gathered.scale, gathered.hidden,
                   changed);
}

void Frame::render(const Camera& camera, const CascadeObserver& observer) {
  session_.timeline().clear();  // the events of every frame would add up
  grids_ = cascade_grids(camera.eye, options_.cascades, options_.cascade_size, options_.grid);
  prepare_light(camera);
  rasterize_camera(camera);
  lights_.rasterize_shadows();
  for (int cascade = options_.cascades; cascade-- > 0;) light_cascade(cascade, observer);
  {
    const StageScope scope(session_, {Pass::gather});
    gather(*camera_surface_, irradiance_);
  }
  const StageScope scope(session_, {Pass::shade});
  shader_.light(*camera_surface_, lights_.shadowed());
  shader_.show(Show::full, *camera_surface_, irradiance_, image_);
  shown_ = Show::full;
}

GatheredLight Frame::light() const {
  GatheredLight light{grids_, {}, sight_ ? &sight_->hidden() : nullptr, lights_.scale()};
  for (const KeptVolume& accumulated : accumulated_) light.accumulated.push_back(accumulated.volume.get());
  return light;
}

std::vector<float> Frame::irradiance_on(const SurfaceImage& surfaces) {
  const std::size_t numbers = surfaces.depth.size() * 4;
  const Surface there = upload_surface(session_, {surfaces.view, surfaces.depth, surfaces.normal, {}, {}});
  Buffer irradiance = session_.buffer(numbers * sizeof(float), "irradiance on given surfaces");
  gather(there, irradiance);
  return session_.read<float>(irradiance, numbers);
}

std::vector<float> Frame::read(Show view) {
  if (view != shown_) shader_.show(view, *camera_surface_, irradiance_, image_);
  shown_ = view;
  std::vector<float> image =
      session_.read<float>(image_, static_cast<std::size_t>(options_.width) * options_.height * 4);
  if (scene_.sky && shows_sky(view)) paint_sky(*scene_.sky, camera_surface_->view, image);
  return image;
}

}  // namespace clpv
