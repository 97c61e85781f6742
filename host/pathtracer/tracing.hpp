// SPDX-License-Identifier: MIT
// Work on several threads, whose exceptions reach the caller.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <exception>
#include <glm/glm.hpp>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "pathtracer/path_tracer.hpp"
#include "scene/scene.hpp"
#include "support/error.hpp"

namespace clpv::pathtracer {

/// Calls work(failed) on `count` threads, this one included, and waits for all. After an exception
/// `failed` is true, at which the others should end; rethrows the first one. Throws Error(run_time)
/// if the system has not so many threads.
template <typename Work>
void on_threads(int count, const Work& work) {
  std::atomic<bool> failed{false};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto run = [&] {
    try {
      work(failed);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failed.exchange(true)) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    try {
      for (int t = 1; t < count; ++t) others.emplace_back(run);
    } catch (const std::system_error& error) {
      failed = true;
      throw Error(ExitCode::run_time, "threads: found {}, of which the system started {}: {}",
                  count, others.size() + 1, error.code().message());
    }
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

// Numbers of paths on the way to a noise.

/// Paths before the first estimate of the noise that may end the tracing.
inline constexpr std::uint32_t kFirstSamples = 64;

/// The next number of paths, of the sequence 2^k, 3 * 2^(k-1), 2^(k+1), where Sobol points have the
/// lowest discrepancy.
inline std::uint32_t next_count(std::uint32_t samples) {
  const bool power = (samples & (samples - 1)) == 0;
  return power ? samples + samples / 2 : samples / 3 * 4;
}

/// Expected number of paths for the target noise, as the error of scrambled Sobol points falls with
/// n^(-3/4).
inline double expected_count(std::uint32_t samples, double noise, double target) {
  return samples * std::pow(std::max(1.0, noise / target), 4.0 / 3.0);
}

/// Throws Error(usage) for options out of range.
inline void check(const PathTracerOptions& options) {
  if (options.bounces < 0)
    throw Error(ExitCode::usage, "bounces: found {}; allowed: 1 or more, or 0 for all",
                options.bounces);
  if (options.samples > PathTracerOptions::kMaxSamples)
    throw Error(ExitCode::usage, "samples: found {}; allowed: 0 to {}", options.samples,
                PathTracerOptions::kMaxSamples);
  if (options.threads < 0 || options.threads > PathTracerOptions::kMaxThreads)
    throw Error(ExitCode::usage, "threads: found {}; allowed: 1 to {}, or 0 for one per processor",
                options.threads, PathTracerOptions::kMaxThreads);
  if (!(options.noise > 0))
    throw Error(ExitCode::usage, "noise: found {}; allowed: above 0", options.noise);
}

// A scene moved to the coordinates' origin, where floats resolve small distances wherever the scene
// lies.

inline void move(float position[3], const glm::dvec3& by) {
  for (int axis = 0; axis < 3; ++axis) position[axis] = double{position[axis]} + by[axis];
}

inline void move(ClpvMedium& medium, const glm::dvec3& by) {
  move(medium.lower, by), move(medium.upper, by);
}

/// A scene and its lights, moved.
struct CentredScene {
  SceneData scene;
  std::vector<SceneLight> lights;

  CentredScene(const SceneData& at, const std::vector<SceneLight>& lit_by, const glm::dvec3& by)
      : scene(at), lights(lit_by) {
    for (Vertex& v : scene.vertices) move(v.position, by);
    for (SceneLight& light : lights) move(light.data.position, by), move(light.data.medium, by);
    if (scene.medium) move(*scene.medium, by);
  }
};

}  // namespace clpv::pathtracer
