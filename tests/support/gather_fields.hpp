// SPDX-License-Identifier: MIT
// Fields of known light, surfaces that walk through them, and what the kernels and the CPU reference gather there.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "pipeline/gather.hpp"
#include "reference/gather.hpp"
#include "tests/support/on_device.hpp"

namespace clpv::test {

inline constexpr int kGrid = 12;        // cells of a cascade along each axis
inline constexpr float kCell = 0.5f;    // of the finest cascade [m]
inline constexpr double kFloat = 2e-6;  // relative: a dozen roundings of float32
inline constexpr unsigned kPixels = 241;

/// Grid `c`, its middle at the origin; each next cascade has cells twice as large.
inline ClpvGrid grid_of(int c) {
  ClpvGrid grid{};
  grid.cell = kCell * static_cast<float>(1 << c);
  grid.n = kGrid;
  for (float& o : grid.origin) o = -grid.cell * (kGrid / 2);
  return grid;
}

/// Coefficients of a channel in a cell whose centre is at that point, in cells from the grid's origin.
using Fill = std::function<std::vector<double>(int channel, const glm::dvec3& centre)>;

inline reference::Volume volume_of(int coefficients, const Fill& fill) {
  reference::Volume volume(kGrid, coefficients);
  for (int channel = 0; channel < 3; ++channel) {
    for (int z = 0; z < kGrid; ++z) {
      for (int y = 0; y < kGrid; ++y) {
        for (int x = 0; x < kGrid; ++x) {
          const std::vector<double> c = fill(channel, glm::dvec3(x, y, z) + 0.5);
          for (int i = 0; i < coefficients; ++i) {
            volume.at(channel, i, x, y, z) = c[static_cast<std::size_t>(i)];
          }
        }
      }
    }
  }
  return volume;
}

/// c, 2 c, 3 c in the three channels of every cell.
inline reference::Volume uniform(const std::vector<double>& c) {
  return volume_of(static_cast<int>(c.size()), [&](int channel, const glm::dvec3&) {
    std::vector<double> scaled = c;
    for (double& value : scaled) value *= channel + 1;  // channels must not be mixed up
    return scaled;
  });
}

inline std::vector<double> times(double s, std::vector<double> c) {
  for (double& value : c) value *= s;
  return c;
}

/// Surfaces of one normal, pixel i of kPixels at from + (i + 1/2) / kPixels (to - from) [m].
inline SurfaceImage walk(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& normal) {
  const glm::dvec3 right = glm::normalize(to - from),
                   other = std::abs(right.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 up = glm::normalize(glm::cross(right, other)), forward = -glm::cross(right, up);
  const glm::dvec3 eye = (from + to) / 2.0 - forward;
  SurfaceImage image;
  ClpvView& view = image.view;
  view.orthographic = 1;
  for (int i = 0; i < 3; ++i) {
    view.eye[i] = static_cast<float>(eye[i]), view.right[i] = static_cast<float>(right[i]);
    view.up[i] = static_cast<float>(up[i]), view.forward[i] = static_cast<float>(forward[i]);
  }
  view.half_width = static_cast<float>(glm::length(to - from) / 2), view.half_height = 1;
  view.width = kPixels, view.height = 1, view.far_depth = 10;
  image.depth.assign(kPixels, 1.0f);
  image.normal.assign(kPixels, glm::vec4(glm::vec3(normal), 0));
  return image;
}

/// E [W/m^2] a pixel; raw: with the fourth component.
struct Both {
  std::vector<glm::dvec3> device, expected;
  std::vector<cl_float4> raw;
};

/// Gathers `image` from volumes of grid_of(0), grid_of(1), ... `hidden`: bytes as CellVisibility keeps them, for what is visible.
inline Both gather(const Basis& basis, TransportKind transport, GatherOptions options,
                   const std::vector<reference::Volume>& full, const SurfaceImage& image,
                   const std::vector<std::uint8_t>& hidden = {}) {
  options.grid = kGrid;
  std::vector<Volume> device;
  device.reserve(full.size());
  const auto upload = [&](const std::vector<reference::Volume>& volumes) {
    std::vector<const Volume*> uploaded;
    for (const reference::Volume& v : volumes) {
      device.emplace_back(test_session(), VolumeShape{kGrid, basis.size(), 3}, "test: light");
      device.back().write(test_session(), {v.values.begin(), v.values.end()});
      uploaded.push_back(&device.back());
    }
    return uploaded;
  };
  std::vector<ClpvGrid> grids;
  std::vector<reference::Cascade> cascades;
  for (std::size_t c = 0; c < full.size(); ++c) {
    grids.push_back(grid_of(static_cast<int>(c)));
    cascades.push_back({grids[c], &full[c]});
    if (!hidden.empty()) cascades[c].hidden = hidden.data() + c * hidden.size() / full.size();
  }
  Surface camera;
  camera.view = image.view;
  camera.depth = test_session().upload(image.depth, "test: depth");
  camera.normal = test_session().upload(image.normal, "test: normal");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Buffer e =
      test_session().upload(std::vector<cl_float4>(image.depth.size(), {{nan, nan, nan, nan}}), "test: E");
  const bool visible = options.gather == Gathering::visible;
  const Buffer bits = visible ? test_session().upload(hidden, "test: hidden cells") : Buffer();
  Gatherer(test_session(), basis, transport, options)
      .gather(camera, grids, upload(full), e, 1, visible ? &bits : nullptr);
  Both both{{},
            reference::gather(basis, transport, options, cascades, image),
            test_session().read<cl_float4>(e, image.depth.size())};
  for (const cl_float4& v : both.raw) both.device.emplace_back(v.s[0], v.s[1], v.s[2]);
  return both;
}

/// Expects E of every pixel to be `expected(pixel)` times 1, 2, 3 in the three channels.
inline void expect_all(const Both& both, const std::function<double(std::size_t)>& expected, double scale,
                       double allowed) {
  for (std::size_t pixel = 0; pixel < both.device.size(); ++pixel) {
    for (int channel = 0; channel < 3; ++channel) {
      const double e = expected(pixel) * (channel + 1);
      ASSERT_NEAR(both.expected[pixel][channel], e, 1e-6 * scale)
          << "expected, pixel " << pixel << " channel " << channel;
      ASSERT_NEAR(both.device[pixel][channel], e, allowed * scale)
          << "pixel " << pixel << " channel " << channel;
    }
  }
}

inline void expect_all(const Both& both, double expected) {
  expect_all(
      both, [&](std::size_t) { return expected; }, 3 * std::abs(expected), kFloat);
}

/// Where the pixel of a walk is on one axis [m].
inline double along(double from, double to, std::size_t pixel) {
  return from + (to - from) * (static_cast<double>(pixel) + 0.5) / kPixels;
}

inline const glm::dvec3 kTilted = glm::normalize(glm::dvec3(1, -2, 0.5));

}  // namespace clpv::test
