// SPDX-License-Identifier: MIT
#include "pipeline/frame/frame.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "basis/sweep.hpp"
#include "pipeline/frame/cells.hpp"
#include "pipeline/frame/frame_volumes.hpp"
#include "pipeline/raster/view.hpp"
#include "reference/medium.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"

namespace clpv {
namespace {

/// Rejects step propagation of a scene with a sky or medium: it takes no light at the border of the cascades, and attenuates
/// none.
void require_support(const RenderOptions& options, const Scene& scene) {
  const char* what = scene.sky ? "sky" : "medium";
  if ((scene.sky || scene.medium) && options.transport != TransportKind::sweep) {
    throw Error(ExitCode::usage, "transport: found '{}' with a {}, allowed: sweep (or a scene without a {})",
                name_of(options.transport), what, what);
  }
}

constexpr std::size_t kPointsPerRow = 1024;

/// Points as an image without a view. Copies of the last point fill its last row.
SurfaceImage image_of_points(std::vector<glm::vec4> positions, std::vector<glm::vec4> vectors) {
  SurfaceImage points;
  const std::size_t count = positions.size();
  points.view.width = static_cast<unsigned>(std::min(count, kPointsPerRow));
  points.view.height = static_cast<unsigned>((count + kPointsPerRow - 1) / kPointsPerRow);
  const std::size_t pixels = std::size_t{points.view.width} * points.view.height;
  positions.resize(pixels, positions.back());
  vectors.resize(pixels, vectors.back());
  points.position = std::move(positions);
  points.normal = std::move(vectors);
  return points;
}

std::vector<glm::vec4> first_points(const std::vector<float>& image, std::size_t count) {
  std::vector<glm::vec4> values(count);
  std::memcpy(values.data(), image.data(), count * sizeof(glm::vec4));
  return values;
}

/// A sky is far brighter than the interior behind walls, so leaks along diagonal links are most visible with a sky.
constexpr double kClosedUnderASky = 0.75;

Transport transport_for(const RenderOptions& options, const Basis& basis, const Scene& scene) {
  Transport transport = make_transport(options, basis);
  if (scene.sky && options.transport == TransportKind::sweep)
    close_diagonals(std::get<std::vector<SweepLink>>(transport.scheme), kClosedUnderASky);
  return transport;
}

/// Adds the sky's radiance, seen through the medium, to pixels of an RGBA image without alpha, and sets their alpha to 1.
void paint_sky(const Sky& sky, const std::optional<ClpvMedium>& medium, const ClpvView& view,
               std::vector<float>& image) {
  const glm::dvec3 forward = vector(view.forward), right = vector(view.right), up = vector(view.up);
  for (unsigned y = 0; y < view.height; ++y) {
    for (unsigned x = 0; x < view.width; ++x) {
      float* pixel = &image[std::size_t{4} * (std::size_t{y} * view.width + x)];
      if (pixel[3] != 0) continue;
      glm::dvec3 ray = forward;
      if (view.orthographic == 0) {
        ray += (2 * (x + 0.5) / view.width - 1) * double{view.half_width} * right +
               (1 - 2 * (y + 0.5) / view.height) * double{view.half_height} * up;
      }
      const glm::dvec3 along = glm::normalize(ray);
      glm::dvec3 seen(sky.interpolated(along));
      if (medium) {
        const double far = std::numeric_limits<double>::infinity();
        seen *=
            reference::transmittance(*medium, reference::medium_part(*medium, vector(view.eye), along, far));
      }
      for (int channel = 0; channel < 3; ++channel) pixel[channel] += static_cast<float>(seen[channel]);
      pixel[3] = 1;
    }
  }
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
      gatherer_(session, gathered(), options.transport, gather_options(options, scene.medium.has_value())),
      shader_(session, scene.medium.has_value()),
      lights_(session, scene, buffers_, rasterizer_, options_),
      cascades_(session, scene, buffers_, options_, *basis_, swept_.get(), transport_, lights_),
      packed_(options.cascades) {
  require_support(options, scene);
  const bool in_medium = scene.medium.has_value();
  if (options.traces_near())
    near_.emplace(session, gathered(), scene, buffers_, near_options(options, in_medium));
  if (scene.medium) medium_.emplace(session, gathered(), *scene.medium, medium_options(options));
  const std::size_t pixels = std::size_t(options.width) * options.height;
  irradiance_ = session.buffer(pixels * 4 * sizeof(float), "irradiance");
  image_ = session.buffer(pixels * 4 * sizeof(float), "shaded image");
  session.build_described();
  if (near_) near_->finish();
}

void Frame::scene_moved() {
  const unsigned instant = buffers_.clusters->instant();
  upload_moving(session_, scene_, buffers_);
  if (near_ && buffers_.clusters->instant() != instant) near_->move();
}

void Frame::invalidate_light() {
  lights_.invalidate();
  near_hits_.invalidate();
}

void Frame::invalidate() {
  invalidate_light();
  buffers_.clusters->invalidate();
}

void Frame::rasterize_camera(const SceneCamera& camera) {
  const StageScope scope(session_, {Pass::rasterize_camera});
  const ClpvView view = camera_view(camera, options_.width, options_.height);
  if (!camera_surface_) camera_surface_ = make_surface(session_, view, RsmFormat::float32, buffers_.emissive);
  camera_surface_->view = view;
  rasterizer_.rasterize_camera(*camera_surface_);
}

void Frame::require_light(const char* what) const {
  if (light().grids.empty())
    throw Error(ExitCode::usage, "{}: no frame was rendered; allowed: after a render", what);
}

void Frame::gather(const Surface& surface, Buffer& irradiance) {
  const GatheredLight gathered = light();
  std::vector<bool> changed(packed_.size(), false);
  for (std::size_t c = 0; c < changed.size(); ++c)
    packed_[c].update(cascades_.key(c), [&] { changed[c] = true; });
  gatherer_.gather(surface, gathered.grids, gathered.accumulated, irradiance, gathered.scale,
                   gathered.occluded, changed);
}

void Frame::render(const SceneCamera& camera, const CascadeObserver& observer) {
  session_.timeline().clear();  // otherwise the events of all frames would accumulate
  const std::vector<ClpvGrid> grids =
      cascade_grids(camera.eye, options_.cascades, options_.cascade_size, options_.grid);
  lights_.prepare(camera, grids);
  rasterize_camera(camera);
  lights_.rasterize_shadows();
  cascades_.prepare(grids, *camera_surface_);
  for (int cascade = options_.cascades; cascade-- > 0;) cascades_.update(cascade, observer);
  {
    const StageScope scope(session_, {Pass::gather});
    gather(*camera_surface_, irradiance_);
  }
  if (near_) {
    const Fingerprint seen =
        Fingerprint().add(camera_surface_->view).add(grids).add(buffers_.clusters->instant());
    near_hits_.update(seen.value(), [&] {
      const StageScope scope(session_, {Pass::near_trace});
      near_->trace(*camera_surface_, gatherer_);
    });
    const StageScope scope(session_, {Pass::near});
    const GatheredLight light = cascades_.light();
    near_->add(*camera_surface_, gatherer_, lights_.shadowed(), light.scale, light.occluded, irradiance_);
  }
  if (medium_) {
    const StageScope scope(session_, {Pass::medium});
    const GatheredLight light = cascades_.light();
    medium_->scatter(*camera_surface_, gatherer_, lights_.shadowed(), light.scale, light.occluded);
  }
  const StageScope scope(session_, {Pass::shade});
  shader_.light(*camera_surface_, lights_.shadowed());
  show(Show::full);
}

void Frame::show(Show view) {
  if (view != Show::medium) shader_.show(view, *camera_surface_, irradiance_, image_);
  if (medium_ && shows_medium(view)) medium_->add(*camera_surface_, view == Show::medium, image_);
  shown_ = view;
}

std::vector<float> Frame::irradiance_on(const SurfaceImage& surfaces) {
  const std::size_t numbers = surfaces.normal.size() * 4;
  const Surface there =
      upload_surface(session_, {surfaces.view, surfaces.depth, surfaces.normal, {}, {}, surfaces.position});
  Buffer irradiance = session_.buffer(numbers * sizeof(float), "irradiance on given surfaces");
  gather(there, irradiance);
  return session_.read<float>(irradiance, numbers);
}

std::vector<glm::vec4> Frame::irradiance_at(std::vector<glm::vec4> positions,
                                            std::vector<glm::vec4> normals) {
  require_light("irradiance");
  const std::size_t count = positions.size();
  if (count == 0) return {};
  return first_points(irradiance_on(image_of_points(std::move(positions), std::move(normals))), count);
}

std::vector<glm::vec4> Frame::radiance_at(std::vector<glm::vec4> positions,
                                          std::vector<glm::vec4> directions) {
  require_light("radiance");
  if (!swept_) {
    throw Error(ExitCode::usage, "radiance: found transport '{}', allowed: sweep",
                name_of(options_.transport));
  }
  if (!gatherer_.packs()) {
    throw Error(
        ExitCode::usage,
        "radiance: found layout 'image' with gather 'all', allowed: gather 'visible', or another layout");
  }
  const std::size_t count = positions.size();
  if (count == 0) return {};
  const SurfaceImage points = image_of_points(std::move(positions), std::move(directions));
  const Buffer places = session_.upload(points.position, "points"),
               vectors = session_.upload(points.normal, "directions");
  const std::size_t numbers = points.position.size() * 4;
  Buffer radiances = session_.buffer(numbers * sizeof(float), "radiance at points");
  if (!radiance_) {
    radiance_.emplace(session_, with_radiance({"gather/radiance.cl", {}, {}}, *swept_, gather_options(options_)),
                      "radiance");
  }
  const GatheredLight gathered = light();
  radiance_->set(points.view, places, vectors, radiances);
  gatherer_.add_radiance(*radiance_, gathered.scale, gathered.occluded);
  radiance_->launch(rows_of_tiles(points.view), kTileRow);
  return first_points(session_.read<float>(radiances, numbers), count);
}

std::vector<SurfaceImage> Frame::read_rsms(int cascade) {
  require_light("RSMs");
  lights_.rasterize_rsms(cascade);  // cascades may share their memory
  std::vector<SurfaceImage> images;
  for (const Surface* rsm : lights_.rsms(cascade)) {
    SurfaceImage& image = images.emplace_back(read_surface(session_, *rsm));
    for (glm::vec4& flux : image.colour) flux /= lights_.scale();
  }
  return images;
}

/// Draws the spheres of visible_spheres() with the irradiance that gathering has at their cells' centres.
void Frame::draw_cells(std::vector<float>& image) {
  const std::size_t pixels = std::size_t(options_.width) * options_.height;
  const CellSpheres spheres = visible_spheres(
      camera_surface_->view, session_.read<float>(camera_surface_->depth, pixels), light().grids.front());
  const double lift = gather_options(options_).gather_offset * double{light().grids.front().cell};
  std::vector<glm::vec4> positions, normals;
  for (std::size_t i = 0; i < spheres.pixels.size(); ++i) {
    positions.emplace_back(glm::vec3(spheres.centres[i] - lift * spheres.normals[i]), 0);
    normals.emplace_back(glm::vec3(spheres.normals[i]), 0);
  }
  const std::vector<glm::vec4> light = irradiance_at(std::move(positions), std::move(normals));
  for (std::size_t i = 0; i < light.size(); ++i) {
    float* pixel = &image[4 * spheres.pixels[i]];
    for (int channel = 0; channel < 3; ++channel) pixel[channel] = light[i][channel];
    pixel[3] = 1;
  }
}

std::vector<float> Frame::read(Show view) {
  if (view == Show::cells) {
    std::vector<float> image = read(Show::irradiance);
    draw_cells(image);
    return image;
  }
  if (view == Show::medium && !medium_)
    throw Error(ExitCode::usage, "view: found 'medium' of a scene without a medium; allowed: the others");
  if (view != shown_) show(view);
  std::vector<float> image = session_.read<float>(image_, std::size_t(options_.width) * options_.height * 4);
  if (scene_.sky && shows_sky(view)) {
    paint_sky(*scene_.sky, view == Show::full ? scene_.medium : std::nullopt, camera_surface_->view, image);
  } else if (medium_ && shows_medium(view)) {
    for (std::size_t i = 3; i < image.size(); i += 4) image[i] = 1;
  }
  return image;
}

Image view_image(Frame& frame, Show view) {
  Image image = make_image(frame.options().width, frame.options().height, {"R", "G", "B", "A"});
  image.pixels = frame.read(view);
  return image;
}

}  // namespace clpv
