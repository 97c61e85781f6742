// SPDX-License-Identifier: MIT
#include "pipeline/frame.hpp"

#include <algorithm>
#include <utility>

#include "basis/sweep.hpp"
#include "pipeline/light_scale.hpp"
#include "pipeline/view.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

VolumeShape light_shape(const RenderOptions& options, const Basis& basis) {
  return {options.grid, basis.size(), 3};
}

VolumeShape geometry_shape(const RenderOptions& options, const Basis& basis) {
  return {options.grid + 1, blocking_size(options.blocking, basis), 1};
}

bool sweeps(const RenderOptions& options) {
  return options.transport == TransportKind::sweep;
}

std::unique_ptr<Basis> swept_basis(const RenderOptions& options) {
  return sweeps(options) ? make_basis("bins24") : nullptr;
}

/// Geometry volumes that a frame keeps.
int geometry_volumes(const RenderOptions& options) {
  if (!options.occlusion) return 0;
  return options.blockers == Blockers::scene ? options.cascades : 1;
}

/// Of what is hidden, in one buffer.
std::size_t sight_bytes(const RenderOptions& options, int grid) {
  return options.gather == Gathering::visible
             ? SceneSight::bytes(grid) * static_cast<std::size_t>(options.cascades)
             : 0;
}

/// Bytes of the volumes of a frame at this grid.
double volume_bytes(const RenderOptions& options, const Basis& basis, int grid) {
  RenderOptions tried = options;
  tried.grid = grid;
  const auto bytes = [&](const VolumeShape& shape) {
    return static_cast<double>(stored_bytes(options.format(), shape));
  };
  const VolumeShape lit = light_shape(tried, basis), blocking = geometry_shape(tried, basis),
                    carried{grid, options.state == State::fluxes ? 6 : basis.size(), 3};
  const double masks =
      options.blockers == Blockers::scene ? static_cast<double>(SceneBlocker::bytes(grid)) : 0;
  const auto sight = static_cast<double>(sight_bytes(options, grid));
  if (sweeps(options)) {
    return sight + bytes(lit) + options.cascades * bytes({grid, kSweepBins, 3}) +
           geometry_volumes(options) * bytes(blocking) + masks + Sweeper::bytes(sweep_options(tried));
  }
  // What adding takes besides: steps, and what is carried down, add to light; injection adds to its cells.
  const auto spare = [&](const VolumeShape& shape) {
    return static_cast<double>(Accumulator::spare_bytes(options.format(), shape));
  };
  const auto cells = [&](const VolumeShape& shape) {
    return static_cast<double>(Accumulator::cells_bytes(options.format(), shape));
  };
  return sight + bytes(lit) * (1 + options.cascades) + 3 * bytes(carried) +
         (1 + geometry_volumes(options)) * bytes(blocking) + masks + 2 * spare(lit) + spare(carried) +
         cells(lit) + cells(blocking);
}

/// Refuses a grid whose volumes exceed the device, naming the largest that fits.
void require_memory(const Session& session, const RenderOptions& options, const Basis& basis) {
  const Device& device = session.device();
  const auto fits = [&](int grid) {
    const std::size_t one = stored_bytes(options.format(), {grid, std::max(6, basis.size()), 3});
    return std::max(one, sight_bytes(options, grid)) <= device.max_alloc_bytes &&
           volume_bytes(options, basis, grid) <= static_cast<double>(device.memory_bytes);
  };
  if (fits(options.grid)) return;
  int grid = options.grid;
  while (grid > 1 && !fits(grid)) --grid;
  throw Error(ExitCode::run_time,
              "grid {}: light volumes of {} need {:.0f} MiB; {} has {} MiB, {} MiB a buffer; the largest "
              "grid that fits "
              "is {}",
              options.grid, basis.name(), volume_bytes(options, basis, options.grid) / 1048576, device.name,
              device.memory_bytes >> 20, device.max_alloc_bytes >> 20, grid);
}

PropagateOptions tuned(PropagateOptions options, const Tuning& tuning) {
  options.lanes = tuning.lanes, options.local = tuning.local;
  return options;
}

/// Refuses what a sweep cannot do, and what the scene's triangles cannot.
void require_compatible(const RenderOptions& options) {
  if (options.occlusion && options.blockers == Blockers::scene && options.blocking != Blocking::areas) {
    throw Error(ExitCode::usage,
                "blocking: found '{}' with blockers 'scene', allowed: areas (or blockers 'seen')",
                name_of(options.blocking));
  }
  if (!sweeps(options)) return;
  if (options.state != State::coefficients) {
    throw Error(ExitCode::usage, "state: found '{}' with transport 'sweep', allowed: coefficients",
                name_of(options.state));
  }
  if (options.lobe_time != LobeTime::host) {
    throw Error(ExitCode::usage,
                "lobe-time: found '{}' with transport 'sweep', which has no lobes; allowed: host",
                name_of(options.lobe_time));
  }
}

const RenderOptions& checked(const Session& session, const RenderOptions& options, const Basis& basis) {
  require_compatible(options);
  require_supported(session.device(), options.format(), light_shape(options, basis));
  require_memory(session, options, basis);
  return options;
}

}  // namespace

Frame::Frame(Session& session, const Scene& scene, const RenderOptions& options, const Tuning& tuning)
    : session_(session),
      scene_(scene),
      basis_(make_basis(options)),
      swept_(swept_basis(options)),
      options_(checked(session, options, *basis_)),
      transport_(make_transport(options, *basis_)),
      buffers_(upload_scene(session, scene)),
      rasterizer_(session, buffers_),
      injector_(session, *basis_, inject_options(options, transport_.unit_flux_lobes)),
      gatherer_(session, gathered(), swept_ ? make_transport(TransportKind::sweep, *swept_) : transport_,
                gather_options(options)),
      shader_(session),
      injected_(session, light_shape(options, *basis_), "injected light", options.format()) {
  for (int c = 0; c < options.cascades; ++c) {
    accumulated_.push_back(std::make_unique<Volume>(session, light_shape(options, gathered()),
                                                    "accumulated light", options.format()));
  }
  if (swept_) {
    sweeper_.emplace(session, *basis_, transport_, sweep_options(options));
  } else {
    propagator_.emplace(session, *basis_, transport_, tuned(propagate_options(options), tuning));
  }
  for (int i = 0; i < geometry_volumes(options); ++i) {
    geometry_.push_back(std::make_unique<Volume>(session, geometry_shape(options, *basis_), "geometry volume",
                                                 options.format()));
  }
  if (options.occlusion && options.blockers == Blockers::scene)
    blocker_.emplace(session, buffers_, options.grid, options.format());
  if (options.gather == Gathering::visible) sight_.emplace(session, buffers_, options.grid, options.cascades);
  blocked_.resize(static_cast<std::size_t>(options.cascades));
  seen_.resize(blocked_.size());
  const auto pixels = static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
  irradiance_ = session.buffer(pixels * 4 * sizeof(float), "irradiance");
  image_ = session.buffer(pixels * 4 * sizeof(float), "shaded image");
  session.build_described();
}

void Frame::scene_moved() {
  upload_moving(session_, scene_, buffers_);
  // The scene's own triangles block and hide anew where some of them may have moved.
  if (scene_.moving.empty()) return;
  std::fill(blocked_.begin(), blocked_.end(), std::nullopt);
  std::fill(seen_.begin(), seen_.end(), std::nullopt);
}

/// Lights as the scene has them now. Their buffers are kept as long as the same ones shine.
void Frame::prepare_lights(const Camera& camera) {
  const std::vector<Light> shining = scene_.lights_for(camera);
  if (lights_.size() != shining.size() || lit_by_ != camera.light) lights_.clear();
  lit_by_ = camera.light;
  lights_.resize(shining.size());
  for (std::size_t i = 0; i < shining.size(); ++i) {
    const auto same = [&](const Light& other) { return other.name == shining[i].name; };
    const auto found = std::find_if(scene_.lights.begin(), scene_.lights.end(), same);
    LitLight& lit = lights_[i];
    lit.light = lit.shadow.light = shining[i].data;
    lit.index = static_cast<int>(found - scene_.lights.begin());
    lit.shadow.views = shadow_views(lit.light, buffers_.bounds, options_.shadow_size);
    const auto texels =
        static_cast<std::size_t>(options_.shadow_size) * static_cast<std::size_t>(options_.shadow_size);
    while (lit.shadow.depths.size() < lit.shadow.views.size())
      lit.shadow.depths.push_back(session_.buffer(texels * sizeof(float), "shadow map"));
  }
}

void Frame::rasterize_camera(const Camera& camera) {
  const StageScope scope(session_, {Pass::rasterize_camera});
  const ClpvView view = camera_view(camera, options_.width, options_.height);
  if (!camera_surface_) camera_surface_ = make_surface(session_, view, RsmFormat::float32, buffers_.emissive);
  camera_surface_->view = view;
  rasterizer_.rasterize_camera(*camera_surface_);
}

void Frame::rasterize_shadows() {
  for (LitLight& lit : lights_) {
    const StageScope scope(session_, {Pass::rasterize_shadow, {}, lit.index});
    for (std::size_t v = 0; v < lit.shadow.views.size(); ++v) {
      rasterizer_.rasterize_shadow(lit.shadow.views[v], lit.shadow.depths[v]);
    }
  }
}

void Frame::rasterize_rsms(int cascade) {
  for (LitLight& lit : lights_) {
    if (cascade < options_.cascades - 1 && !rsm_follows_cascade(lit.light))
      continue;  // the coarsest is first
    const StageScope scope(session_, {Pass::rasterize_rsm, cascade, lit.index});
    const auto views =
        rsm_views(lit.light, grids_[static_cast<std::size_t>(cascade)], buffers_.bounds, options_.rsm_size);
    for (std::size_t v = 0; v < views.size(); ++v) {
      if (lit.rsms.size() <= v)
        lit.rsms.push_back(make_surface(session_, views[v], options_.rsm_format, false));
      lit.rsms[v].view = views[v];
      rasterizer_.rasterize_rsm(scaled(lit.light, light_scale_), lit.rsms[v]);
    }
  }
}

void Frame::inject(int cascade) {
  const StageScope scope(session_, {Pass::inject_light, cascade});
  injected_.clear(session_);
  for (const LitLight& lit : lights_) {
    for (const Surface& rsm : lit.rsms)
      injector_.inject_light(rsm, grids_[static_cast<std::size_t>(cascade)], injected_);
  }
}

void Frame::inject_geometry(int cascade) {
  const StageScope scope(session_, {Pass::inject_geometry, cascade});
  const ClpvGrid& grid = grids_[static_cast<std::size_t>(cascade)];
  Volume& geometry = geometry_of(cascade);
  geometry.clear(session_);
  for (const LitLight& lit : lights_) {
    for (const Surface& rsm : lit.rsms) injector_.inject_geometry(rsm, grid, geometry);
  }
  injector_.inject_geometry(*camera_surface_, grid, geometry, options_.blocker_stride);
}

/// Whether what is known of a cascade is known of the grid it has now; from here on it is.
bool Frame::stands(std::vector<std::optional<ClpvGrid>>& known, int cascade) const {
  const auto c = static_cast<std::size_t>(cascade);
  const ClpvGrid& now = grids_[c];
  const std::optional<ClpvGrid> before = std::exchange(known[c], now);
  return before && std::equal(now.origin, now.origin + 3, before->origin) && before->cell == now.cell;
}

/// Whether anything had to be done: a scene blocks as before while the grid stands.
bool Frame::block(int cascade) {
  if (stands(blocked_, cascade)) return false;
  const StageScope scope(session_, {Pass::block, cascade});
  blocker_->block(grids_[static_cast<std::size_t>(cascade)], geometry_of(cascade));
  return true;
}

void Frame::see(int cascade) {
  if (!sight_ || stands(seen_, cascade)) return;
  const StageScope scope(session_, {Pass::see, cascade});
  sight_->see(static_cast<std::size_t>(cascade), grids_[static_cast<std::size_t>(cascade)]);
}

void Frame::propagate(int cascade) {
  const auto c = static_cast<std::size_t>(cascade);
  const Volume* geometry = nullptr;
  bool changed = false;
  if (!geometry_.empty()) {
    geometry = &geometry_of(cascade);
    if (blocker_) {
      changed = block(cascade);
    } else {
      inject_geometry(cascade);
      changed = true;
    }
  }
  const StageScope scope(session_, {Pass::propagate, cascade});
  if (propagator_) {
    propagator_->propagate({injected_, geometry, *accumulated_[c]}, options_.iterations);
    return;
  }
  if (changed) sweeper_->block(c, *geometry);
  sweeper_->sweep(c, grids_, injected_, *accumulated_[c]);
}

void Frame::light_cascade(int cascade, const CascadeObserver& observer) {
  rasterize_rsms(cascade);
  inject(cascade);
  propagate(cascade);
  see(cascade);
  if (!observer) return;
  const auto c = static_cast<std::size_t>(cascade);
  observer({cascade, grids_[c], injected_, geometry_.empty() ? nullptr : &geometry_of(cascade),
            *accumulated_[c], light_scale_});
}

void Frame::render(const Camera& camera, const CascadeObserver& observer) {
  prepare_lights(camera);
  grids_ = cascade_grids(camera.eye, options_.cascades, options_.cascade_size, options_.grid);
  std::vector<ClpvLight> lights;
  for (const LitLight& lit : lights_) lights.push_back(lit.light);
  light_scale_ = light_scale(options_.format(), lights, grids_.back().cell);
  rasterize_camera(camera);
  rasterize_shadows();
  // A sweep takes what comes in at a cascade's border from the next coarser one. Steps do in any order.
  for (int cascade = options_.cascades; cascade-- > 0;) light_cascade(cascade, observer);
  {
    const StageScope scope(session_, {Pass::gather});
    const GatheredLight gathered = light();
    gatherer_.gather(*camera_surface_, gathered.grids, gathered.accumulated, irradiance_, gathered.scale,
                     gathered.hidden);
  }
  std::vector<ShadowedLight> shadowed;
  for (const LitLight& lit : lights_) shadowed.push_back(lit.shadow);
  const StageScope scope(session_, {Pass::shade});
  shader_.light(*camera_surface_, shadowed);
  shader_.show(Show::full, *camera_surface_, irradiance_, image_);
  shown_ = Show::full;
}

GatheredLight Frame::light() const {
  GatheredLight light{grids_, {}, sight_ ? &sight_->hidden() : nullptr, light_scale_};
  for (const auto& volume : accumulated_) light.accumulated.push_back(volume.get());
  return light;
}

std::vector<float> Frame::read(Show view) {
  if (view != shown_) shader_.show(view, *camera_surface_, irradiance_, image_);
  shown_ = view;
  return session_.read<float>(image_, static_cast<std::size_t>(options_.width) * options_.height * 4);
}

}  // namespace clpv
