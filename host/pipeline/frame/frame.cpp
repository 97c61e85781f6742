// SPDX-License-Identifier: MIT
#include "pipeline/frame/frame.hpp"

#include <algorithm>
#include <cstring>

#include "options/stage_options.hpp"
#include "pipeline/raster/paint.hpp"
#include "pipeline/raster/view.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"

namespace clpv {
namespace {

constexpr std::size_t kPointsPerRow = 1024;

/// Points as an image without a view. Copies of the last point fill its last row.
SurfaceImage image_of_points(std::vector<glm::vec4> positions, std::vector<glm::vec4> vectors) {
  SurfaceImage points;
  const std::size_t count = positions.size();
  points.view.width = static_cast<unsigned>(std::min(count, kPointsPerRow));
  points.view.height = static_cast<unsigned>((count + kPointsPerRow - 1) / kPointsPerRow);
  const std::size_t pixels = std::size_t{points.view.width} * points.view.height;
  for (glm::vec4& position : positions) position.w = 1;
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

}  // namespace

Frame::Frame(Session& session, const SceneData& scene, const RenderOptions& options)
    : Frame(session, scene, FrameSetup(options, scene)) {}

Frame::Frame(Session& session, const SceneData& scene, FrameSetup setup)
    : session_(session),
      scene_(scene),
      setup_(std::move(setup)),
      buffers_(upload_scene(session, scene)),
      rasterizer_(session, buffers_),
      gatherer_(session, gathered(), options().transport,
                gather_options(options(), buffers_.medium)),
      shader_(session, buffers_.medium),
      near_step_(near_options(options()).step),
      light_step_(near_step_),
      lights_(session, scene, buffers_, rasterizer_, setup_),
      cascades_(session, scene, buffers_, setup_, lights_) {
  if (options().traces_near())
    near_.emplace(session, gathered(), scene, buffers_, near_options(options()));
  if (scene.medium) medium_.emplace(session, gathered(), *scene.medium, medium_options(options()));
  draw_ahead(false);
  make_images();
  ClpvView view = {};  // fails for images that do not fit before kernels compile
  view.width = options().width, view.height = options().height;
  make_surface(session, view, RsmFormat::float32, buffers_.emissive);
  session.programs().build_described();
  if (near_) near_->finish();
}

void Frame::make_images() {
  const std::size_t bytes = std::size_t(options().width) * options().height * sizeof(cl_float4);
  irradiance_ = {}, image_ = {};  // first: memory may not suffice for both sizes
  irradiance_ = session_.buffer(bytes, "irradiance");
  image_ = session_.buffer(bytes, "shaded image");
}

void Frame::resize(int width, int height) {
  if (width == options().width && height == options().height && image_.exists()) return;
  setup_.options.width = width, setup_.options.height = height;
  camera_surface_.reset();
  near_hits_.invalidate();
  make_images();
}

void Frame::prepare_near(int step) {
  if (!options().traces_near() || (near_ && near_step_ == step)) return;
  NearOptions near = near_options(options());
  near.step = near_step_ = step;
  near_hits_.invalidate();
  near_.emplace(session_, gathered(), scene_, buffers_, near);
  session_.programs().build_described();
  near_->finish();
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

std::vector<ClpvGrid> Frame::grids_about(const glm::vec3& eye) const {
  return cascade_grids(eye, options().cascades, options().cascade_size, options().grid);
}

void Frame::gather(const Surface& surface, CacheKey rays, Buffer& irradiance) {
  timed(Pass::gather, [&] { gatherer_.gather(surface, light(), irradiance); });
  if (!near_) return;
  near_hits_.update(rays,
                    [&] { timed(Pass::near_trace, [&] { near_->trace(surface, gatherer_); }); });
  timed(Pass::near, [&] { near_->add(surface, gatherer_, lights_.shadowed(), irradiance); });
}

void Frame::rasterize_camera(const SceneCamera& camera) {
  const ClpvView view = camera_view(camera, options().width, options().height);
  if (!camera_surface_)
    camera_surface_ = make_surface(session_, view, RsmFormat::float32, buffers_.emissive);
  camera_surface_->view = view;
  rasterizer_.rasterize_camera(*camera_surface_);
}

void Frame::require_light(const char* what) const {
  if (light().grids.empty())
    throw Error(ExitCode::usage, "{}: no frame was rendered; allowed: after a render", what);
}

void Frame::require_lookups(const char* what) const {
  if (!setup_.sweeps()) {
    throw Error(ExitCode::usage, "{}: found transport '{}', allowed: sweep", what,
                name_of(options().transport));
  }
}

std::string Frame::lookup_source() const {
  require_lookups("lookup source");
  return program_text(with_radiance({"gather/lookup.h"}, gathered(), gather_options(options()))) +
         "#line 1 \"kernel\"\n";
}

CacheKey Frame::seen_by_rays(const std::vector<ClpvGrid>& grids) const {
  return Fingerprint()
      .add(camera_surface_->view)
      .add(grids)
      .add(buffers_.clusters->instant())
      .value();
}

void Frame::render(const SceneCamera& camera, const CascadeObserver& observer) {
  session_.timeline().clear();  // otherwise the events of all frames would accumulate
  prepare_near(near_options(options()).step);
  const std::vector<ClpvGrid> grids = grids_about(camera.eye);
  lights_.prepare(camera, grids);
  timed(Pass::rasterize_camera, [&] { rasterize_camera(camera); });
  lights_.rasterize_shadows();
  cascades_.prepare(grids, &*camera_surface_);
  for (int cascade = options().cascades; cascade-- > 0;) cascades_.update(cascade, observer);
  const std::vector<ShadowedLight> shadowed = lights_.shadowed();
  gather(*camera_surface_, seen_by_rays(grids), irradiance_);
  if (medium_)
    timed(Pass::medium, [&] { medium_->scatter(*camera_surface_, gatherer_, shadowed); });
  timed(Pass::shade, [&] {
    shader_.light(*camera_surface_, shadowed);
    show(Show::full);
  });
  session_.timeline().enqueued();
}

void Frame::enqueue_light(const SceneCamera& camera) {
  setup_.require_own_blockers();
  session_.timeline().clear();
  const std::vector<ClpvGrid> grids = grids_about(camera.eye);
  lights_.prepare(camera, grids);
  lights_.rasterize_shadows();
  cascades_.prepare(grids, nullptr);
  for (int cascade = options().cascades; cascade-- > 0;) cascades_.update(cascade, {});
}

void Frame::update(const SceneCamera& camera) {
  enqueue_light(camera);
  timed(Pass::gather, [&] { gatherer_.take(light()); });
  session_.timeline().enqueued();
}

const Buffer& Frame::light(const SceneCamera& camera, const GivenPixels& pixels) {
  prepare_near(light_step_);
  enqueue_light(camera);
  const Surface& surface = given_.take(
      camera_view(camera, static_cast<int>(pixels.width), static_cast<int>(pixels.height)), pixels);
  session_.reserve(given_irradiance_, std::size_t{pixels.width} * pixels.height * sizeof(cl_float4),
                   "irradiance on a given surface");
  near_hits_.invalidate();  // their content is unknown
  gather(surface, 0, given_irradiance_);
  near_hits_.invalidate();
  session_.timeline().enqueued();
  return given_irradiance_;
}

void Frame::show(Show view) {
  if (view != Show::medium) shader_.show(view, *camera_surface_, irradiance_, image_);
  if (medium_ && shows_medium(view)) medium_->add(*camera_surface_, view == Show::medium, image_);
  shown_ = view;
}

std::vector<float> Frame::irradiance_on(const SurfaceImage& surfaces) {
  const std::size_t numbers = surfaces.normal.size() * 4;
  const Surface there = upload_surface(
      session_, {surfaces.view, surfaces.depth, surfaces.normal, {}, {}, surfaces.position});
  Buffer irradiance = session_.buffer(numbers * sizeof(float), "irradiance on given surfaces");
  gatherer_.gather(there, light(), irradiance);
  return session_.read<float>(irradiance, numbers);
}

std::vector<glm::vec4> Frame::irradiance_at(std::vector<glm::vec4> positions,
                                            std::vector<glm::vec4> normals) {
  require_light("irradiance");
  const std::size_t count = positions.size();
  if (count == 0) return {};
  return first_points(irradiance_on(image_of_points(std::move(positions), std::move(normals))),
                      count);
}

std::vector<glm::vec4> Frame::radiance_at(std::vector<glm::vec4> positions,
                                          std::vector<glm::vec4> directions) {
  require_light("radiance");
  require_lookups("radiance");
  const std::size_t count = positions.size();
  if (count == 0) return {};
  const SurfaceImage points = image_of_points(std::move(positions), std::move(directions));
  const Buffer places = session_.upload(points.position, "points"),
               vectors = session_.upload(points.normal, "directions");
  const std::size_t numbers = points.position.size() * 4;
  Buffer radiances = session_.buffer(numbers * sizeof(float), "radiance at points");
  if (!radiance_) {
    radiance_.emplace(session_,
                      with_radiance({"gather/radiance.cl"}, gathered(), gather_options(options())),
                      "radiance");
  }
  radiance_->set(points.view, places, vectors, radiances);
  gatherer_.add_radiance(*radiance_);
  radiance_->launch(items_of(session_, points.view), pixel_group(session_));
  return first_points(session_.read<float>(radiances, numbers), count);
}

std::vector<SurfaceImage> Frame::read_rsms(int cascade) {
  require_light("RSMs");
  lights_.rasterize_rsms(cascade, cascade);  // cascades may share their memory
  std::vector<SurfaceImage> images;
  for (const Surface* rsm : lights_.rsms(cascade)) {
    SurfaceImage& image = images.emplace_back(read_surface(session_, *rsm));
    for (glm::vec4& flux : image.colour) flux /= lights_.scale();
  }
  return images;
}

const Buffer& Frame::image(Show view) {
  if (view == Show::medium && !medium_)
    throw Error(ExitCode::usage,
                "view: found 'medium' of a scene without a medium; allowed: the others");
  if (view != shown_) show(view);
  return image_;
}

std::vector<float> Frame::read(Show view) {
  if (view == Show::cells) {
    std::vector<float> image = read(Show::irradiance);
    const ClpvView& seen = camera_surface_->view;
    paint_cells(
        light().grids.front(), options().gather_offset,
        [this](auto positions, auto normals) {
          return irradiance_at(std::move(positions), std::move(normals));
        },
        seen, session_.read<float>(camera_surface_->depth, std::size_t{seen.width} * seen.height),
        image);
    return image;
  }
  std::vector<float> image =
      session_.read<float>(this->image(view), std::size_t(options().width) * options().height * 4);
  if (scene_.sky && shows_sky(view)) {
    paint_sky(*scene_.sky, view == Show::full ? scene_.medium : std::nullopt, camera_surface_->view,
              image);
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
