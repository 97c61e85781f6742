// SPDX-License-Identifier: MIT
// Implements clpv/renderer.hpp and clpv/pathtrace.hpp.
#include "clpv/renderer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "api/renderer_state.hpp"
#include "clpv/pathtrace.hpp"
#include "pathtracer/path_tracer.hpp"
#include "pathtracer/point_tracer.hpp"
#include "pathtracer/tracing.hpp"
#include "pipeline/raster/view.hpp"
#include "scene/bounds.hpp"
#include "support/error.hpp"
#include "support/log.hpp"
#include "times/time_record.hpp"

namespace clpv {
namespace {

using Clock = std::chrono::steady_clock;

using Vectors = std::span<const std::array<float, 3>>;

/// Points with a unit vector each.
struct Points {
  std::vector<glm::vec4> positions, vectors;
};

/// Checks points and a vector of any length for each. Messages name the function and the vectors:
/// "irradiance", "normal".
Points checked_points(const char* function, const char* vector, Vectors positions,
                      Vectors vectors) {
  if (positions.size() != vectors.size() && vectors.size() != 1) {
    throw Error(ExitCode::usage,
                "{}: found {} positions and {} {}s, allowed: equal numbers, or one {}", function,
                positions.size(), vectors.size(), vector, vector);
  }
  Points points;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto &p = positions[i], &v = vectors[vectors.size() == 1 ? 0 : i];
    const glm::dvec3 along(v[0], v[1], v[2]);
    const double length = glm::length(along);
    if (!(length > 0 && std::isfinite(length) && std::isfinite(p[0] + p[1] + p[2]))) {
      throw Error(ExitCode::usage,
                  "{}: point {}: found position ({}, {}, {}) and {} ({}, {}, {}), allowed: finite "
                  "numbers, a nonzero {}",
                  function, i, p[0], p[1], p[2], vector, v[0], v[1], v[2], vector);
    }
    points.positions.emplace_back(p[0], p[1], p[2], 0);
    points.vectors.emplace_back(glm::vec3(along / length), 0);
  }
  return points;
}

std::vector<std::array<float, 3>> without_alpha(const std::vector<glm::vec4>& values) {
  std::vector<std::array<float, 3>> colours;
  for (const glm::vec4& value : values) colours.push_back({value.x, value.y, value.z});
  return colours;
}

void check(const GBuffer& surfaces) {
  check_sides("light: width and height", surfaces.width, surfaces.height);
  const std::size_t pixels = std::size_t(surfaces.width) * std::size_t(surfaces.height);
  const auto require = [&](const char* what, std::size_t found, const char* more) {
    if (found == pixels) return;
    throw Error(ExitCode::usage, "light: found {} {} for {} x {} pixels, allowed: one for each{}",
                found, what, surfaces.width, surfaces.height, more);
  };
  require("normals", surfaces.normals.size(), "");
  if (surfaces.positions.empty()) {
    require("depths", surfaces.depths.size(), ", or positions");
  } else {
    require("positions", surfaces.positions.size(), "");
    if (!surfaces.depths.empty())
      throw Error(ExitCode::usage, "light: found positions and depths, allowed: one of both");
  }
}

std::vector<glm::vec4> four_wide(Vectors vectors) {
  std::vector<glm::vec4> wide;
  wide.reserve(vectors.size());
  for (const std::array<float, 3>& v : vectors) wide.emplace_back(v[0], v[1], v[2], 0);
  return wide;
}

GivenPixels uploaded(Session& session, const GBuffer& surfaces) {
  GivenPixels pixels{
      .width = static_cast<unsigned>(surfaces.width),
      .height = static_cast<unsigned>(surfaces.height),
      .points = !surfaces.positions.empty(),
      .places = {},
      .normals = session.upload(four_wide(surfaces.normals), "normals of a G-buffer")};
  if (pixels.points) {
    pixels.places = session.upload(four_wide(surfaces.positions), "positions of a G-buffer");
  } else {
    pixels.places = session.buffer(surfaces.depths.size_bytes(), "depths of a G-buffer");
    session.write(pixels.places, surfaces.depths, 0);
  }
  return pixels;
}

}  // namespace

void check_view(View view) {
  if (!name_of(view).empty()) return;
  throw Error(ExitCode::usage, "view: found {}, allowed: 0..{}", static_cast<int>(view),
              static_cast<int>(View::cells));
}

void check_sides(const char* what, int width, int height) {
  constexpr int kMaxSide = 16384;
  if (width >= 1 && width <= kMaxSide && height >= 1 && height <= kMaxSide) return;
  throw Error(ExitCode::usage, "{}: found {} x {}, allowed: 1..{}", what, width, height, kMaxSide);
}

SceneCamera camera_at(const char* function, const Vec3& eye) {
  return scene_camera(Camera{.eye = eye, .target = {eye[0], eye[1], eye[2] - 1}},
                      rejected_in(function));
}

std::vector<std::array<float, 3>> Renderer::State::light(const SceneCamera& camera,
                                                         const GBuffer& surfaces) {
  frame->draw_ahead(false);
  const Buffer& irradiance = light(camera, uploaded(session, surfaces));
  return without_alpha(session.read<glm::vec4>(irradiance, surfaces.normals.size()));
}

Renderer::Renderer(const Scene& scene, const Options& options, const std::string& device)
    : state_(std::make_unique<State>(scene, options, choose_device(device))) {}

Renderer::~Renderer() {
  if (!state_) return;
  try {
    state_->session.programs().store();
  } catch (const std::exception& error) {  // a cache never makes the program fail
    log_debug("compiled programs not cached: {}", error.what());
  }
}

Renderer::State& Renderer::state() const {
  if (!state_)
    throw Error(ExitCode::usage,
                "renderer: found one that was moved from, allowed: the one that it moved to");
  return *state_;
}

Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Image Renderer::render(View view, const CameraChoice& camera, double seconds,
                       const ImageSize& size) {
  check_view(view);
  if (size) check_sides("size", (*size)[0], (*size)[1]);
  State& state = this->state();
  const std::lock_guard lock(state.mutex);
  const std::shared_lock scene_stays(state.file.contents().mutex);
  const Clock::time_point started = Clock::now();
  state.render(camera, seconds, size);
  Image image = state.image(view);
  state.frame_ms = ms_since(started);
  return image;
}

Image Renderer::show(View view) {
  check_view(view);
  const std::lock_guard lock(state().mutex);
  const std::shared_lock scene_stays(state().file.contents().mutex);
  state().require_image("show");
  return view == View::cells ? state().cells() : state().image(view);
}

std::vector<std::array<float, 3>> Renderer::light(const GBuffer& surfaces,
                                                  const CameraChoice& camera, double seconds) {
  check(surfaces);
  const std::lock_guard lock(state().mutex);
  const std::shared_lock scene_stays(state().file.contents().mutex);
  state().require_light_alone();
  const SceneCamera chosen = state().pose(camera, seconds);
  return state().light(chosen, surfaces);
}

std::vector<std::array<float, 3>> Renderer::light(const GBuffer& surfaces, const Vec3& eye,
                                                  double seconds) {
  check(surfaces);
  if (surfaces.positions.empty())
    throw Error(ExitCode::usage,
                "light: found depths and an eye, allowed: positions, or depths and a camera");
  const SceneCamera camera = camera_at("light", eye);
  const std::lock_guard lock(state().mutex);
  const std::shared_lock scene_stays(state().file.contents().mutex);
  state().require_light_alone();
  state().pose(seconds);
  return state().light(camera, surfaces);
}

void Renderer::update(const Vec3& eye, double seconds) {
  const SceneCamera camera = camera_at("update", eye);
  const std::lock_guard lock(state().mutex);
  const std::shared_lock scene_stays(state().file.contents().mutex);
  state().update(camera, seconds);
}

void Renderer::release() {
  const std::lock_guard lock(state().mutex);
  state().frame.reset();
  state().metadata.clear();
  state().lit = false;
}

std::array<double, 3> Renderer::irradiance(const Vec3& position, const Vec3& normal) {
  const std::array<float, 3> p{float(position[0]), float(position[1]), float(position[2])},
      n{float(normal[0]), float(normal[1]), float(normal[2])};
  const std::array<float, 3> e = irradiance(std::span(&p, 1), std::span(&n, 1))[0];
  return {e[0], e[1], e[2]};
}

std::vector<std::array<float, 3>> Renderer::irradiance(
    std::span<const std::array<float, 3>> positions,
    std::span<const std::array<float, 3>> normals) {
  Points points = checked_points("irradiance", "normal", positions, normals);
  const std::lock_guard lock(state().mutex);
  state().require_light("irradiance");
  return without_alpha(
      state().frame->irradiance_at(std::move(points.positions), std::move(points.vectors)));
}

std::vector<std::array<float, 3>> Renderer::radiance(
    std::span<const std::array<float, 3>> positions,
    std::span<const std::array<float, 3>> directions) {
  Points points = checked_points("radiance", "direction", positions, directions);
  const std::lock_guard lock(state().mutex);
  state().require_light("radiance");
  return without_alpha(
      state().frame->radiance_at(std::move(points.positions), std::move(points.vectors)));
}

std::vector<LightVolume> Renderer::volumes() {
  const std::lock_guard lock(state().mutex);
  state().require_light("volumes");
  const GatheredLight light = state().frame->light();
  std::vector<LightVolume> all;
  for (std::size_t c = 0; c < light.grids.size(); ++c) {
    const ClpvGrid& grid = light.grids[c];
    const VolumeShape& shape = light.accumulated[c]->shape();
    LightVolume& volume = all.emplace_back();
    volume.origin = {grid.origin[0], grid.origin[1], grid.origin[2]};
    volume.cell = grid.cell;
    volume.n = shape.n;
    volume.coefficients = shape.coefficients;
    volume.basis = state().frame->gathered().name();
    std::vector<float> values = light.accumulated[c]->read(state().session);
    const auto furnace =
        values.begin() + static_cast<std::ptrdiff_t>(values.size() / shape.channels * 3);
    volume.furnace.assign(furnace, values.end());
    values.erase(furnace, values.end());
    for (float& value : values) value /= light.scale;
    volume.values = std::move(values);
  }
  return all;
}

std::string Renderer::description() const {
  return state().description;
}

Stats Renderer::stats() const {
  const std::lock_guard lock(state().mutex);
  Stats stats;
  const HostWork& host = state().session.timeline().host();
  stats.times = {time_record("frame", {state().frame_ms}), time_record("host", {host.host_ms})};
  for (const StageTime& stage : state().session.timeline().times())
    stats.times.push_back(time_record(stage.mark, {stage.ms}));
  stats.launches = host.launches, stats.waits = host.waits;
  stats.build_ms = state().session.programs().build_ms();
  stats.device_bytes = state().session.device_bytes();
  stats.peak_device_bytes = state().session.peak_device_bytes();
  return stats;
}

Image pathtrace(const Scene& scene, View view, const CameraChoice& camera,
                const TraceOptions& options) {
  return pathtrace(scene, std::vector{view}, camera, options);
}

Image pathtrace(const Scene& scene, const std::vector<View>& views, const CameraChoice& camera,
                const TraceOptions& options) {
  if (views.empty()) throw Error(ExitCode::usage, "view: found none, allowed: at least one");
  for (const View view : views) {
    check_view(view);
    require_traceable(view);
    if (std::ranges::count(views, view) > 1)
      throw Error(ExitCode::usage, "view: found '{}' twice, allowed: once", name_of(view));
  }
  check_sides("width and height", options.width, options.height);
  const std::shared_lock scene_stays(scene.contents().mutex);
  PosedScene posed(scene);
  posed.pose(options.seconds);
  const SceneCamera chosen = posed.camera(camera);
  const std::uint32_t samples = std::ranges::any_of(views, needs_paths) ? options.samples : 1;
  const pathtracer::TracedImage traced = pathtracer::trace_paths(
      posed.scene(), posed.scene().lights_for(chosen),
      camera_view(chosen, options.width, options.height),
      {options.bounces, samples, options.noise, options.seed, options.threads}, options.progress);
  Image image;
  for (const View view : views)
    append_layer(image, pathtracer::traced_view(traced, view),
                 views.size() == 1 ? std::string() : std::string(name_of(view)));
  image.metadata = {{"camera", chosen.name},
                    {"time", fmt::format("{}", options.seconds)},
                    {"spp_traced", fmt::format("{}", traced.samples)},
                    {"noise_reached", fmt::format("{}", traced.noise)}};
  return image;
}

PointLights pathtrace_points(const Scene& scene, Vectors positions, Vectors normals,
                             const TraceOptions& options) {
  const pathtracer::PathTracerOptions paths{options.bounces, options.samples, options.noise,
                                            options.seed, options.threads};
  pathtracer::check(paths);
  if (positions.size() > pathtracer::kMaxTracedPoints)
    throw Error(ExitCode::usage, "pathtrace_points: found {} points, allowed: at most {}",
                positions.size(), pathtracer::kMaxTracedPoints);
  const Points checked = checked_points("pathtrace_points", "normal", positions, normals);
  std::vector<SurfacePoint> points;
  for (std::size_t i = 0; i < checked.positions.size(); ++i) {
    const glm::vec4& p = checked.positions[i];
    if (!glm::all(glm::lessThanEqual(glm::abs(glm::dvec3(p)), glm::dvec3(bounds::kCoordinate))))
      throw Error(ExitCode::usage,
                  "pathtrace_points: point {}: found position ({}, {}, {}), allowed: within +-{} m",
                  i, p.x, p.y, p.z, bounds::kCoordinate);
    points.push_back({glm::dvec3(p), glm::dvec3(checked.vectors[i])});
  }
  const std::shared_lock scene_stays(scene.contents().mutex);
  PosedScene posed(scene);
  posed.pose(options.seconds);
  pathtracer::PointTracer tracer(posed.scene(), posed.scene().lights_for(SceneCamera()), paths);
  const pathtracer::TracedPoints traced = tracer.irradiance(points, options.progress);
  PointLights lights;
  lights.samples = traced.samples, lights.noise = traced.noise;
  const auto add = [](std::vector<std::array<float, 3>>& to, const glm::dvec3& v) {
    to.push_back({static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
  };
  for (const pathtracer::PointLight& light : traced.points) {
    add(lights.indirect, light.indirect), add(lights.direct, light.direct);
    add(lights.error, light.error);
  }
  return lights;
}

}  // namespace clpv
