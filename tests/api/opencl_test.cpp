// SPDX-License-Identifier: MIT
// Renderers in a caller's context and queue, and their results as device memory (clpv/opencl.hpp).
#include "clpv/opencl.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CL/opencl.hpp>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <thread>

#include "device/device.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/numbers.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::opencl_test {
using ::testing::AllOf;
using ::testing::HasSubstr;
using Vectors = std::vector<std::array<float, 3>>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;
using test::kCornell;

struct Owned {
  cl::Device device = choose_device().handle;
  cl::Context context{device};
  cl::CommandQueue queue{context, device, CL_QUEUE_PROFILING_ENABLE};

  opencl::Queue given() const { return {context(), queue()}; }
  std::vector<float> read(cl_mem memory, std::size_t numbers) const {
    std::vector<float> values(numbers);
    queue.enqueueReadBuffer(cl::Buffer(memory, true), CL_TRUE, 0, numbers * sizeof(float),
                            values.data());
    return values;
  }
  cl::Buffer buffer(const Vectors& vectors) const {
    std::vector<float> wide;
    for (const auto& v : vectors) wide.insert(wide.end(), {v[0], v[1], v[2], NAN});
    return {context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, wide.size() * sizeof(float),
            wide.data()};
  }
};

TEST(OpenCl, FramesInACallersQueueAreThoseOfItsOwn) {
  const Owned own;
  const Scene scene(kCornell);
  Renderer renderer(scene, test::small_options(), own.given()), other(scene, test::small_options());
  const Image full = other.render();
  EXPECT_EQ(renderer.render().pixels, full.pixels);
  opencl::Frame frame = renderer.enqueue(View::albedo);
  EXPECT_EQ(frame.width, 48);
  const std::size_t pixels = 48 * 27;
  EXPECT_EQ(own.read(frame.image, 4 * pixels), other.show(View::albedo).pixels);
  cl_int status = CL_QUEUED;
  clGetEventInfo(frame.done.get(), CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status, &status,
                 nullptr);
  EXPECT_EQ(status, CL_COMPLETE) << "after a read in the same queue";
  EXPECT_EQ(test::colours(own.read(frame.irradiance, 4 * pixels)),
            test::colours(other.show(View::irradiance).pixels));
  EXPECT_EQ(test::colours(own.read(frame.normals, 4 * pixels)),
            test::colours(other.show(View::normal).pixels));
  EXPECT_EQ(own.read(frame.depth, pixels)[700], other.show(View::depth).at(700 % 48, 700 / 48, 0));
  EXPECT_GT(ms_of(renderer.stats().times, "gather"), 0);
  EXPECT_EQ(renderer.show(View::full).pixels, full.pixels);
  EXPECT_THROW(renderer.enqueue(View::cells), Error);
}

/// Keeps a queue from going on until it is released.
class Barrier {
 public:
  explicit Barrier(const Owned& own) : event_(own.context) {
    const std::vector<cl::Event> events = {event_};
    own.queue.enqueueBarrierWithWaitList(&events);
    own.queue.flush();
    // Frees a test that waits for the queue.
    guard_ = std::thread([this] {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, std::chrono::seconds(20), [this] { return released_; });
      late_ = !released_;
      event_.setStatus(CL_COMPLETE);
    });
  }
  /// Returns true if nothing waited.
  bool release() {
    {
      const std::lock_guard lock(mutex_);
      released_ = true;
    }
    changed_.notify_one();
    guard_.join();
    return !late_;
  }

 private:
  cl::UserEvent event_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool released_ = false, late_ = false;
  std::thread guard_;
};

TEST(OpenCl, FramesAreEnqueuedAheadOfTheQueue) {
  const Owned own;
  Scene scene(kCornell);
  Renderer renderer(scene, test::small_options(), own.given()), other(scene, test::small_options());
  Camera camera = scene.cameras().front();
  std::vector<Light> lights = scene.lights();
  ASSERT_FALSE(lights.empty());
  const auto move = [&] {
    camera.eye[2] += 0.1;  // cascades move
    lights[0].position[0] += 0.01;
    scene.set_lights(lights);
  };
  renderer.enqueue(View::full, camera);  // compiles
  move();
  renderer.enqueue(View::full, camera);
  for (int moved = 0; moved < 3; ++moved) {
    move();
    Barrier barrier(own);
    const opencl::Frame frame = renderer.enqueue(View::full, camera),
                        next = renderer.enqueue(View::full, camera);
    const opencl::Frame last = renderer.enqueue(View::full, camera);
    EXPECT_TRUE(barrier.release()) << "an enqueued frame waited for the queue";
    EXPECT_EQ(own.read(last.image, 4 * 48 * 27), other.render(View::full, camera).pixels);
    EXPECT_EQ(renderer.stats().waits, 0u);
  }
}

TEST(OpenCl, LightFromAndToBuffersIsThatOfTheHost) {
  const Owned own;
  const Scene scene(kCornell);
  Renderer renderer(scene, test::small_options(), own.given());
  const Camera camera = scene.cameras().front();
  const opencl::Frame frame = renderer.enqueue(View::full, camera);
  const cl::Buffer light(own.context, CL_MEM_WRITE_ONLY, 48 * 27 * 16 + 4);
  const Vectors expected = test::colours(own.read(frame.irradiance, 48 * 27 * 4));
  renderer.enqueue_light({48, 27, frame.normals, nullptr, frame.depth, light()}, camera).wait();
  EXPECT_EQ(test::colours(own.read(light(), 48 * 27 * 4)), expected);

  Vectors positions, normals;
  for (int i = 0; i < 48 * 27; ++i) {
    positions.push_back(
        {0.01f * static_cast<float>(i % 48), 0.27f, 0.02f * static_cast<float>(i / 48)});
    normals.push_back({0, i % 2 == 0 ? -1.0f : 3.0f, 0});
  }
  const Vec3 eye{0.278, 0.273, 0.2};
  const cl::Buffer p = own.buffer(positions), n = own.buffer(normals);
  const opencl::Event done = renderer.enqueue_light({48, 27, n(), p(), nullptr, light()}, eye);
  EXPECT_EQ(done.wait(), CL_SUCCESS);
  EXPECT_EQ(
      test::colours(own.read(light(), 48 * 27 * 4)),
      renderer.light({.width = 48, .height = 27, .normals = normals, .positions = positions}, eye));
}

TEST(OpenCl, ACallersKernelLooksLightUp) {
  for (const char* gather : {"visible", "all"}) {
    const Owned own;
    Renderer renderer(Scene(kCornell), test::small_options().set("gather", gather), own.given());
    EXPECT_THROW(renderer.device_volumes(), Error) << "before the first frame";
    renderer.render();
    Vectors points, along;
    for (int i = 0; i < 50; ++i) {
      points.push_back({0.01f * static_cast<float>(i), 0.27f, 0.3f});
      along.push_back({0, i % 2 == 0 ? -1.0f : 1.0f, 0});
    }
    cl::Program program(own.context, renderer.lookup_source() + R"(
      __kernel void look_up(__global const float4* points, __global const float4* along, __global float4* found,
                            CLPV_RADIANCE) {
        const uint i = get_global_id(0);
        found[2 * i] = clpv_irradiance(CLPV_PASS_RADIANCE, points[i].xyz, along[i].xyz);
        found[2 * i + 1] = clpv_radiance(CLPV_PASS_RADIANCE, points[i].xyz, along[i].xyz);
      })");
    program.build("-cl-std=CL1.2");
    cl::Kernel kernel(program, "look_up");
    const cl::Buffer p = own.buffer(points), a = own.buffer(along),
                     found(own.context, CL_MEM_READ_WRITE, 50 * 2 * 16);
    const opencl::Volumes volumes = renderer.device_volumes();
    EXPECT_EQ(volumes.occluded == nullptr, std::string(gather) == "all");
    kernel.setArg(0, p), kernel.setArg(1, a), kernel.setArg(2, found);
    kernel.setArg(3, sizeof(cl_mem), &volumes.grids);
    kernel.setArg(4, volumes.cascades), kernel.setArg(5, volumes.unit);
    kernel.setArg(6, sizeof(cl_mem), &volumes.packed);
    if (volumes.occluded != nullptr) kernel.setArg(7, sizeof(cl_mem), &volumes.occluded);
    own.queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(50));
    const Vectors values = test::colours(own.read(found(), 50 * 2 * 4));
    const Vectors irradiance = renderer.irradiance(points, along),
                  radiance = renderer.radiance(points, along);
    for (std::size_t i = 0; i < 50; ++i) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(values[2 * i][c], irradiance[i][c], 1e-5 + 1e-4 * irradiance[i][c])
            << gather << i;
        EXPECT_NEAR(values[2 * i + 1][c], radiance[i][c], 1e-5 + 1e-4 * std::abs(radiance[i][c]))
            << gather << i;
      }
    }
    EXPECT_GT(irradiance[0][0], 0);
  }
  Renderer steps(Scene(kCornell),
                 test::small_images().set("transport", "exact").set("near", "off"));
  EXPECT_THAT(test::error_of(ExitCode::usage, [&] { steps.lookup_source(); }),
              HasSubstr("transport 'exact'"));
}

TEST(OpenCl, ReferencesAreReturned) {
  const Owned own;
  const auto references = [&] {
    return std::pair(own.context.getInfo<CL_CONTEXT_REFERENCE_COUNT>(),
                     own.queue.getInfo<CL_QUEUE_REFERENCE_COUNT>());
  };
  const auto before = references();
  {
    Renderer renderer(Scene(kCornell), test::few_steps(), own.given());
    EXPECT_GT(references(), before);
    renderer.enqueue();
  }
  EXPECT_EQ(references(), before);
  cl::Buffer kept;
  std::vector<float> values;
  {
    Renderer renderer(Scene(kCornell), test::few_steps(), own.given());
    const opencl::Frame frame = renderer.enqueue();
    kept = cl::Buffer(frame.image, true);
    values = own.read(frame.image, 4 * 48 * 27);
  }
  EXPECT_EQ(own.read(kept(), 4 * 48 * 27), values) << "retained by the caller";
}

TEST(OpenCl, WrongObjectsAreNamed) {
  const Owned own, other;
  const Scene scene(kCornell);
  const auto rejected = [&](const std::string& part, const opencl::Queue& queue) {
    EXPECT_THAT(test::error_of(ExitCode::usage, [&] { Renderer(scene, test::few_steps(), queue); }),
                AllOf(HasSubstr(part), HasSubstr("allowed")));
  };
  rejected("context and queue: found neither", {});
  rejected("queue: found one of another context", {own.context(), other.queue()});
  const cl::CommandQueue unordered(own.context, own.device, CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
  rejected("queue: found an out-of-order one", {nullptr, unordered()});
  Renderer renderer(scene, test::few_steps(), {own.context(), nullptr});
  const cl::Buffer good(own.context, CL_MEM_READ_WRITE, 2 * 2 * 16),
      short_(own.context, CL_MEM_READ_WRITE, 63),
      foreign(other.context, CL_MEM_READ_WRITE, 2 * 2 * 16);
  const auto refused = [&](const std::string& part, const opencl::GBuffer& surfaces) {
    EXPECT_THAT(test::error_of(ExitCode::usage, [&] { renderer.enqueue_light(surfaces, Vec3{}); }),
                AllOf(HasSubstr("light: "), HasSubstr(part), HasSubstr("allowed")));
  };
  refused("normals: found none", {2, 2, nullptr, good(), nullptr, good()});
  refused("positions: found 63 bytes, allowed: at least 64",
          {2, 2, good(), short_(), nullptr, good()});
  refused("irradiance: found a buffer of another context",
          {2, 2, good(), good(), nullptr, foreign()});
  refused("no positions for an eye", {2, 2, good(), nullptr, good(), good()});
  refused("positions and depths", {2, 2, good(), good(), good(), good()});
  refused("found 0 x 2", {0, 2, good(), good(), nullptr, good()});
  if (own.device.getInfo<CL_DEVICE_IMAGE_SUPPORT>() == CL_TRUE) {
    const cl::Image2D image(own.context, CL_MEM_READ_WRITE, cl::ImageFormat(CL_RGBA, CL_FLOAT), 4,
                            4);
    refused("normals: found an image", {2, 2, image(), good(), nullptr, good()});
  }
}

/// Runs the test that calls it again, in a process with other devices. Returns false in that
/// process.
bool passes_with(const std::string& variables) {
  if (std::getenv("CLPV_TEST_AGAIN") != nullptr) return false;
  const ::testing::TestInfo& test = *::testing::UnitTest::GetInstance()->current_test_info();
  const test::Outcome outcome = test::run(
      variables + " CLPV_TEST_AGAIN=1 " + std::filesystem::read_symlink("/proc/self/exe").string() +
      " --gtest_filter=" + test.test_suite_name() + "." + test.name());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("[  PASSED  ] 1 test")) << outcome.err;
  return true;
}

/// Devices of the first platform that has two.
std::vector<Device> two_devices() {
  std::map<int, std::vector<Device>> by_platform;
  for (const Device& device : list_devices().devices) {
    std::vector<Device>& those = by_platform[device.platform_index];
    if (device.supported()) those.push_back(device);
    if (those.size() == 2) return those;
  }
  return {};
}

TEST(OpenCl, EitherOfTwoDevicesInOneContext) {
  const std::vector<Device> devices = two_devices();
  if (devices.empty()) {
    if (choose_device().platform != "Portable Computing Language")
      GTEST_SKIP() << "one device, and a driver that cannot make it two";
    EXPECT_TRUE(passes_with("POCL_DEVICES='pthread pthread'"));
    return;
  }
  const cl::Context both({devices[0].handle, devices[1].handle}), one(devices[0].handle);
  const Scene scene(kCornell);
  const Options options = test::few_steps().set("blockers", "scene");  // light() needs them
  const std::vector<float> expected = Renderer(scene, options).render().pixels;
  EXPECT_THAT(
      test::error_of(ExitCode::usage,
                     [&] {
                       Renderer(scene, options, {both(), nullptr});
                     }),
      HasSubstr(
          "context: found 2 devices and no queue, allowed: one device, or a queue for one of"));
  std::vector<cl::CommandQueue> queues;
  std::vector<Renderer> renderers;
  for (const Device& device : devices) {
    const cl::CommandQueue& queue = queues.emplace_back(both, device.handle);
    renderers.emplace_back(scene, options, opencl::Queue{both(), queue()});
    EXPECT_THAT(renderers.back().description(), HasSubstr(device.name));
    EXPECT_THAT(test::error_of(ExitCode::usage,
                               [&] {
                                 Renderer(scene, options, {one(), queue()});
                               }),
                HasSubstr("queue: found one of another context"));
  }
  std::vector<opencl::Frame> frames;
  for (Renderer& renderer : renderers) frames.push_back(renderer.enqueue());
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(frames[i].done.wait(), CL_SUCCESS);
    EXPECT_EQ(renderers[i].show(View::full).pixels, expected) << devices[i].name;
  }
}

TEST(OpenCl, AContextWithoutAUsableDeviceIsNamed) {
  if (passes_with("LD_PRELOAD=" CLPV_OPENCL_SHIM " CLPV_SHIM_COMPILER=no")) return;
  ASSERT_FALSE(list_devices().devices.empty());
  const Device useless = list_devices().devices.front();
  ASSERT_FALSE(useless.supported());
  const cl::Context context(useless.handle);
  const cl::CommandQueue queue(context, useless.handle);
  for (const opencl::Queue& given :
       {opencl::Queue{context(), nullptr}, opencl::Queue{nullptr, queue()}}) {
    EXPECT_THAT(
        test::error_of(ExitCode::device,
                       [&] { Renderer(Scene(kCornell), test::few_steps(), given); }),
        AllOf(HasSubstr("queue: found one of " + useless.name), HasSubstr("lacks: compiler")));
  }
}

TEST(OpenCl, ObjectsOfAFrameInFlightMayGo) {
  const Owned own;
  Scene scene(kCornell);
  const Triangles square{{0, 1, 2}, {0, 2, 3}};
  const Vectors screen{
      {0.1f, 0.1f, 0.2f}, {0.4f, 0.1f, 0.2f}, {0.4f, 0.4f, 0.2f}, {0.1f, 0.4f, 0.2f}};
  const std::vector<float> without = Renderer(scene, test::few_steps()).render().pixels;
  const int mesh = scene.add_mesh({.positions = screen, .triangles = square});
  const std::vector<float> with = Renderer(scene, test::few_steps()).render().pixels;
  EXPECT_NE(with, without);
  Renderer renderer(scene, test::few_steps(), own.given());
  renderer.enqueue();  // compiles
  Barrier barrier(own);
  const opencl::Frame frame = renderer.enqueue();
  const cl::Buffer kept(frame.image, true);
  scene.remove_mesh(mesh);
  EXPECT_TRUE(barrier.release());
  const opencl::Frame next = renderer.enqueue();  // in other memory
  EXPECT_EQ(own.read(kept(), 4 * 48 * 27), with);
  EXPECT_EQ(own.read(next.image, 4 * 48 * 27), without);
}

}  // namespace clpv::opencl_test
