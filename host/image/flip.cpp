// SPDX-License-Identifier: MIT
#include "image/flip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <numbers>

#include "image/tone_map.hpp"

namespace clpv {
namespace flip_metric {

using std::numbers::pi;
using Plane = std::vector<double>;
using Planes = std::array<Plane, 3>;

// Exponents and split points of section 4.
constexpr double kColourExponent = 0.7, kFeatureExponent = 0.5, kSplit = 0.4, kSplitValue = 0.95;
constexpr double kEdgeWidth = 0.082;  // width of a feature [degrees]

/// Contrast sensitivity of a channel: a sum of two Gaussians of the frequency (section 4.1.1).
struct Sensitivity {
  std::array<double, 2> height, width;
};
constexpr std::array<Sensitivity, 3> kSensitivities = {
    {{{1, 0}, {0.0047, 1e-5}}, {{1, 0}, {0.0053, 1e-5}}, {{34.1, 13.5}, {0.04, 0.025}}}};
constexpr double kWidest = 0.04;

// sRGB primaries and white point D65. GLM's matrices hold columns.
const glm::dmat3 kToXyz = {{10135552.0 / 24577794, 2613072.0 / 12288897, 1425312.0 / 73733382},
                           {8788810.0 / 24577794, 8788810.0 / 12288897, 8788810.0 / 73733382},
                           {4435075.0 / 24577794, 887015.0 / 12288897, 70074185.0 / 73733382}};
const glm::dvec3 kWhite = kToXyz * glm::dvec3(1);

glm::dvec3 ycxcz(const glm::dvec3& linear) {
  const glm::dvec3 t = kToXyz * linear / kWhite;
  return {116 * t.y - 16, 500 * (t.x - t.y), 200 * (t.y - t.z)};
}

glm::dvec3 linear_of(const glm::dvec3& ycxcz) {
  const double y = (ycxcz.x + 16) / 116;
  return glm::inverse(kToXyz) * (glm::dvec3(y + ycxcz.y / 500, y, y - ycxcz.z / 200) * kWhite);
}

double lab_curve(double t) {
  constexpr double delta = 6.0 / 29;
  return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
}

/// CIELAB with Hunt's adjustment: chroma counts less in the dark.
glm::dvec3 hunt_lab(const glm::dvec3& linear) {
  const glm::dvec3 t = kToXyz * linear / kWhite;
  const glm::dvec3 f = {lab_curve(t.x), lab_curve(t.y), lab_curve(t.z)};
  const double lightness = 116 * f.y - 16;
  return {lightness, 0.01 * lightness * 500 * (f.x - f.y), 0.01 * lightness * 200 * (f.y - f.z)};
}

double hyab(const glm::dvec3& a, const glm::dvec3& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

/// One row of a separable filter, from -radius to radius.
std::vector<double> taps(int radius, const std::function<double(double)>& value) {
  std::vector<double> row;
  for (int i = -radius; i <= radius; ++i) row.push_back(value(i));
  return row;
}

double total(const std::vector<double>& row) {
  double sum = 0;
  for (const double value : row) sum += value;
  return sum;
}

/// Filters rows by `along_x` and columns by `along_y`. Pixels beyond the image equal the nearest
/// one in it.
Plane filtered(const Plane& plane, int width, int height, const std::vector<double>& along_x,
               const std::vector<double>& along_y) {
  const int radius = static_cast<int>(along_x.size()) / 2;
  Plane rows(plane.size(), 0.0), result(plane.size(), 0.0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int i = -radius; i <= radius; ++i)
        rows[y * width + x] +=
            along_x[i + radius] * plane[y * width + std::clamp(x + i, 0, width - 1)];
    }
  }
  for (int y = 0; y < height; ++y) {
    for (int i = -radius; i <= radius; ++i) {
      const int from = std::clamp(y + i, 0, height - 1);
      for (int x = 0; x < width; ++x)
        result[y * width + x] += along_y[i + radius] * rows[from * width + x];
    }
  }
  return result;
}

/// A channel without the detail that is too fine for an observer.
Plane seen(const Plane& plane, int width, int height, const Sensitivity& channel,
           double pixels_per_degree) {
  const int radius =
      static_cast<int>(std::ceil(3 * std::sqrt(kWidest / (2 * pi * pi)) * pixels_per_degree));
  Plane result(plane.size(), 0.0);
  double all = 0;
  for (int k = 0; k < 2; ++k) {
    if (channel.height[k] == 0) continue;
    const auto row = taps(radius, [&](double i) {
      return std::exp(-pi * pi * i * i /
                      (pixels_per_degree * pixels_per_degree * channel.width[k]));
    });
    const double height_of_it = channel.height[k] * std::sqrt(pi / channel.width[k]);
    const Plane part = filtered(plane, width, height, row, row);
    for (std::size_t p = 0; p < plane.size(); ++p) result[p] += height_of_it * part[p];
    all += height_of_it * total(row) * total(row);
  }
  for (double& value : result) value /= all;
  return result;
}

/// Strengths of edges (first derivative) and of points (second derivative) of the lightness.
struct Features {
  Plane edges, points;
};

Features features(const Plane& lightness, int width, int height, double pixels_per_degree) {
  const double deviation = 0.5 * kEdgeWidth * pixels_per_degree, variance = deviation * deviation;
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  const auto smooth = taps(radius, [&](double i) { return std::exp(-i * i / (2 * variance)); });
  // Positive weights add up to 1 and negative ones to -1.
  const auto derivative = [&](const std::function<double(double)>& factor) {
    auto row =
        taps(radius, [&](double i) { return factor(i) * std::exp(-i * i / (2 * variance)); });
    double above = 0, below = 0;
    for (const double value : row) (value > 0 ? above : below) += std::abs(value);
    for (double& value : row) value /= (value > 0 ? above : below) * total(smooth);
    return row;
  };
  const auto strength = [&](const std::vector<double>& row) {
    const Plane along_x = filtered(lightness, width, height, row, smooth),
                along_y = filtered(lightness, width, height, smooth, row);
    Plane both;
    for (std::size_t p = 0; p < along_x.size(); ++p)
      both.push_back(std::hypot(along_x[p], along_y[p]));
    return both;
  };
  return {strength(derivative([](double i) { return -i; })),
          strength(derivative([&](double i) { return i * i / variance - 1; }))};
}

/// An image as an observer sees it.
struct View {
  std::vector<glm::dvec3> colours;  ///< hunt_lab
  Features features;
};

View view_of(const Image& image, double pixels_per_degree) {
  Planes channels;
  for (Plane& plane : channels) plane.resize(image.pixel_count());
  Plane lightness(image.pixel_count());
  for (std::size_t p = 0; p < image.pixel_count(); ++p) {
    const float* encoded = &image.pixels[p * image.channels.size()];
    const glm::dvec3 value =
        ycxcz({srgb_decode(encoded[0]), srgb_decode(encoded[1]), srgb_decode(encoded[2])});
    for (int c = 0; c < 3; ++c) channels[c][p] = value[c];
    lightness[p] = (value.x + 16) / 116;
  }
  for (int c = 0; c < 3; ++c)
    channels[c] =
        seen(channels[c], image.width, image.height, kSensitivities[c], pixels_per_degree);
  View view;
  for (std::size_t p = 0; p < image.pixel_count(); ++p) {
    const glm::dvec3 linear = linear_of({channels[0][p], channels[1][p], channels[2][p]});
    view.colours.push_back(hunt_lab(glm::clamp(linear, 0.0, 1.0)));
  }
  view.features = features(lightness, image.width, image.height, pixels_per_degree);
  return view;
}

/// Maps differences of colour to [0, 1]: the lower 2/5 of them to nearly all of it.
double spread(double difference, double largest) {
  const double split = kSplit * largest;
  if (difference < split) return difference * kSplitValue / split;
  return kSplitValue + (difference - split) / (largest - split) * (1 - kSplitValue);
}

}  // namespace flip_metric

std::vector<double> flip(const Image& a, const Image& b, double pixels_per_degree) {
  using namespace flip_metric;
  const View in_a = view_of(a, pixels_per_degree), in_b = view_of(b, pixels_per_degree);
  const double largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kColourExponent);
  std::vector<double> result;
  for (std::size_t p = 0; p < a.pixel_count(); ++p) {
    const double colour =
        spread(std::pow(hyab(in_a.colours[p], in_b.colours[p]), kColourExponent), largest);
    const double feature = std::max(std::abs(in_a.features.edges[p] - in_b.features.edges[p]),
                                    std::abs(in_a.features.points[p] - in_b.features.points[p]));
    result.push_back(
        std::pow(colour, 1 - std::pow(feature / std::numbers::sqrt2, kFeatureExponent)));
  }
  return result;
}

}  // namespace clpv
