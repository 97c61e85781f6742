// SPDX-License-Identifier: MIT
// Implements what clpv/renderer.hpp has for clpv/opencl.hpp.
#include "api/renderer_state.hpp"
#include "clpv/opencl.hpp"
#include "device/cl_error.hpp"

namespace clpv {
namespace {

/// Completion of all commands enqueued so far, which start now.
opencl::Event all_done(cl::CommandQueue& queue) {
  cl::Event done;
  named_errors([&] {
    queue.enqueueMarkerWithWaitList(nullptr, &done);
    queue.flush();
  });
  return opencl::Event(std::exchange(done(), nullptr));
}

/// Checked buffers of a caller's G-buffer.
struct GivenLight {
  GivenPixels pixels;
  Buffer irradiance;
};

GivenLight checked(const Session& session, const opencl::GBuffer& surfaces) {
  check_sides("light: width and height", surfaces.width, surfaces.height);
  if ((surfaces.positions == nullptr) == (surfaces.depths == nullptr)) {
    throw Error(
        ExitCode::usage, "light: found {}, allowed: positions or depths",
        surfaces.depths == nullptr ? "neither positions nor depths" : "positions and depths");
  }
  const std::size_t count = std::size_t(surfaces.width) * std::size_t(surfaces.height),
                    vectors = count * sizeof(cl_float4);
  GivenPixels pixels{.width = static_cast<unsigned>(surfaces.width),
                     .height = static_cast<unsigned>(surfaces.height),
                     .points = surfaces.positions != nullptr,
                     .places = {},
                     .normals = session.given(surfaces.normals, vectors, "light: normals")};
  pixels.places = pixels.points
                      ? session.given(surfaces.positions, vectors, "light: positions")
                      : session.given(surfaces.depths, count * sizeof(cl_float), "light: depths");
  return {pixels, session.given(surfaces.irradiance, vectors, "light: irradiance")};
}

}  // namespace

Renderer::Renderer(const Scene& scene, const Options& options, const opencl::Queue& queue)
    : state_(std::make_unique<State>(scene, options, given_queue(queue.context, queue.queue))) {}

opencl::Frame Renderer::enqueue(View view, const CameraChoice& camera, double seconds,
                                const ImageSize& size) {
  check_view(view);
  if (size) check_sides("size", (*size)[0], (*size)[1]);
  if (view == View::cells)
    throw Error(ExitCode::usage,
                "enqueue: found view 'cells', which the host paints, allowed: the others");
  State& state = this->state();
  const std::lock_guard lock(state.mutex);
  const std::shared_lock scene_stays(state.file.contents().mutex);
  state.render(camera, seconds, size, true);
  opencl::Frame frame;
  frame.width = state.frame->options().width, frame.height = state.frame->options().height;
  frame.image = state.frame->image(view).handle()();
  frame.irradiance = state.frame->irradiance().handle()();
  frame.depth = state.frame->seen().depth.handle()();
  frame.normals = state.frame->seen().normal.handle()();
  frame.done = all_done(state.session.queue());
  return frame;
}

opencl::Event Renderer::State::enqueue_light(const opencl::GBuffer& surfaces,
                                             const std::function<SceneCamera()>& posed) {
  const std::lock_guard lock(mutex);
  const std::shared_lock scene_stays(file.contents().mutex);
  const auto [pixels, receives] = checked(session, surfaces);
  require_light_alone();
  const SceneCamera camera = posed();
  frame->draw_ahead(true);
  const Buffer& irradiance = light(camera, pixels);
  session.copy(irradiance, receives, std::size_t{pixels.width} * pixels.height * sizeof(cl_float4));
  return all_done(session.queue());
}

opencl::Event Renderer::enqueue_light(const opencl::GBuffer& surfaces, const CameraChoice& camera,
                                      double seconds) {
  return state().enqueue_light(surfaces, [&] { return state().pose(camera, seconds); });
}

opencl::Event Renderer::enqueue_light(const opencl::GBuffer& surfaces, const Vec3& eye,
                                      double seconds) {
  if (surfaces.positions == nullptr)
    throw Error(ExitCode::usage,
                "light: found no positions for an eye, allowed: positions, or depths and a camera");
  const SceneCamera camera = camera_at("light", eye);
  return state().enqueue_light(surfaces, [&] {
    state().pose(seconds);
    return camera;
  });
}

opencl::Volumes Renderer::device_volumes() {
  const std::lock_guard lock(state().mutex);
  state().require_light("device volumes");
  state().frame->require_lookups("device volumes");
  const Gatherer& light = state().frame->gatherer();
  return {.grids = light.grids().handle()(),
          .cascades = light.cascades(),
          .unit = light.unit(),
          .packed = light.packed().handle()(),
          .occluded = light.occluded().handle()()};
}

std::string Renderer::lookup_source() const {
  const std::lock_guard lock(state().mutex);
  state().require(state().frame.has_value(), "lookup source");  // none after a failed rebuild
  return state().frame->lookup_source();
}

}  // namespace clpv
