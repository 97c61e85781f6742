// SPDX-License-Identifier: MIT
// Many frames of changing options in one process: memory stays flat.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "pipeline/frame/frame.hpp"
#include "scene/load.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::soak_test {
namespace {

constexpr double kFlat = 1.01;  // over frames()

/// CLPV_SOAK_FRAMES sets another number.
int frames() {
  const char* wish = std::getenv("CLPV_SOAK_FRAMES");
  return wish != nullptr ? std::atoi(wish) : 20;
}

/// Resident memory of the process [bytes].
double resident_bytes() {
  std::ifstream in("/proc/self/statm");
  double total = 0, resident = 0;
  in >> total >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

/// Frames of other tests' programs.
RenderOptions small(TransportKind transport) {
  RenderOptions options = test::small_sweep();
  options.width = 24, options.height = 18;
  options.cascades = 2, options.cascade_size = 5;
  options.rsm_size = 16, options.shadow_size = 16;
  if (transport == TransportKind::sampled) {
    options.transport = transport, options.grid = 5;
    options.gather = Gathering::all, options.blockers = Blockers::seen;
  }
  return options;
}

TEST(Soak, MemoryStaysFlatOverFramesOfChangingOptions) {
  const std::vector<RenderOptions> all = {small(TransportKind::sweep),
                                          small(TransportKind::sampled)};
  const SceneData scene = load_scene(test::kTiny);
  Session session(choose_device());
  const auto render = [&](int i) {
    Frame frame(session, scene, all[static_cast<std::size_t>(i) % all.size()]);
    frame.render(scene.camera({}));
    frame.read(Show::full);
  };
  const auto render_some = [&] {
    for (int i = 0; i < frames(); ++i) render(i);
  };
  // Programs stay built, and allocators need a few rounds to level out; a leak never does.
  render_some();
  constexpr int kMaxRounds = 6;
  std::vector<double> resident{resident_bytes()};
  const std::size_t device_before = session.device_bytes(),
                    most_before = session.peak_device_bytes();
  do {
    render_some();
    resident.push_back(resident_bytes());
  } while (resident.back() > kFlat * resident.end()[-2] && resident.size() <= kMaxRounds);
  EXPECT_LE(resident.back(), kFlat * resident.end()[-2]) << testing::PrintToString(resident);
  EXPECT_EQ(session.device_bytes(), device_before);
  EXPECT_EQ(session.peak_device_bytes(), most_before);
}

}  // namespace
}  // namespace clpv::soak_test
