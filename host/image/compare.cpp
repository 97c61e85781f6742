// SPDX-License-Identifier: MIT
// Errors of an image against its reference.

#include "image/compare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <numbers>

#include "image/tone_map.hpp"
#include "support/error.hpp"
#include "support/json_optional.hpp"

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

namespace {

// Keeps the relative error of black pixels finite, as is usual.
constexpr double kRelativeFloor = 0.01;

/// R, G and B; or the only channel beside alpha, such as Y.
std::vector<std::size_t> colour_channels(const Image& image, const std::string& name) {
  const auto r = image.channel("R"), g = image.channel("G"), b = image.channel("B");
  if (r && g && b) return {*r, *g, *b};
  std::vector<std::size_t> indices;
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    if (image.channels[c] != "A") indices.push_back(c);
  }
  if (indices.size() == 1) return indices;
  throw Error(ExitCode::bad_input, "{}: found channels {}; allowed: R, G and B, or one", name,
              fmt::join(image.channels, ", "));
}

const float* pixel(const Image& image, std::size_t index) {
  return &image.pixels[index * image.channels.size()];
}

void check_finite(const Image& image, const std::string& name) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    if (std::isfinite(image.pixels[i])) continue;
    const std::size_t p = i / image.channels.size(), c = i % image.channels.size();
    throw Error(ExitCode::bad_input,
                "{}: pixel ({}, {}), channel {}: found {}; allowed: finite values", name,
                p % image.width, p / image.width, image.channels[c], image.pixels[i]);
  }
}

std::string pixels_in(const Image& image) {
  const auto found = image.windows.find("");
  if (found == image.windows.end()) return "all pixels";
  const PixelWindow& window = found->second;
  return fmt::format("only pixels ({}, {}) to ({}, {})", window.left, window.top, window.right - 1,
                     window.bottom - 1);
}

/// True for the pixels that a file has.
bool has_pixel(const Image& image, std::size_t index) {
  const auto found = image.windows.find("");
  if (found == image.windows.end()) return true;
  const PixelWindow& window = found->second;
  const int x = static_cast<int>(index % static_cast<std::size_t>(image.width)),
            y = static_cast<int>(index / static_cast<std::size_t>(image.width));
  return x >= window.left && x < window.right && y >= window.top && y < window.bottom;
}

std::optional<double> ratio(double numerator, double denominator) {
  if (denominator == 0) return std::nullopt;
  return numerator / denominator;
}

/// R, G and B as a display shows them; black where a pixel is not valid.
Image shown(const Image& image, const std::vector<bool>& valid, float exposure) {
  const std::vector<std::size_t> channels = colour_channels(image, {});
  Image rgb = make_image(image.width, image.height, {"R", "G", "B"});
  rgb.encoding = image.encoding;
  for (std::size_t p = 0; p < valid.size(); ++p) {
    for (std::size_t c = 0; c < 3 && valid[p]; ++c)
      rgb.pixels[3 * p + c] = pixel(image, p)[channels[channels.size() < 3 ? 0 : c]];
  }
  return image.encoding == Encoding::srgb ? rgb : display_image(rgb, exposure, ToneMap::aces);
}

/// The file has the pixel, and its alpha, if any, is above 0.
bool is_valid(const Image& image, std::size_t index) {
  const auto alpha = image.channel("A");
  return has_pixel(image, index) && (!alpha || pixel(image, index)[*alpha] > 0);
}

std::vector<bool> valid_pixels(const Image& a, const Image& b) {
  std::vector<bool> valid(a.pixel_count());
  for (std::size_t p = 0; p < valid.size(); ++p) valid[p] = is_valid(a, p) && is_valid(b, p);
  return valid;
}

/// Sums over pairs of values.
struct Sums {
  double a = 0, b = 0, aa = 0, ab = 0, bb = 0, squared_error = 0;
  void add(double x, double y) {
    a += x;
    b += y;
    aa += x * x;
    ab += x * y;
    bb += y * y;
    squared_error += (x - y) * (x - y);
  }
};

/// sqrt(squared_error / reference_power); 0 if both are 0, empty if only the power is 0.
std::optional<double> normalised(double squared_error, double reference_power) {
  if (reference_power == 0 && squared_error == 0) return 0.0;
  const auto quotient = ratio(squared_error, reference_power);
  return quotient ? std::optional(std::sqrt(std::max(*quotient, 0.0))) : std::nullopt;
}

/// Sets the errors over valid pixels from their sums; without any they are undefined.
void set_valid_errors(Comparison& result, const Sums& valid) {
  if (result.valid_pixels == 0) return;
  result.nrmse_valid = normalised(valid.squared_error, valid.bb);
  result.best_gain = ratio(valid.ab, valid.aa);
  // At the best gain g = AB / AA, |gA - B|^2 = BB - AB^2 / AA; a black A has no gain.
  const double explained = valid.aa > 0 ? valid.ab * valid.ab / valid.aa : 0.0;
  result.nrmse_best_gain = valid.squared_error == 0 ? normalised(0, valid.bb)
                                                    : normalised(valid.bb - explained, valid.bb);
  result.energy_ratio = ratio(valid.a, valid.b);
}

double pixel_luminance(const float* values, const std::vector<std::size_t>& channels) {
  if (channels.size() != 3) return values[channels[0]];
  return luminance({values[channels[0]], values[channels[1]], values[channels[2]]});
}

}  // namespace

void check_comparable(const Image& a, const std::string& a_name, const Image& b,
                      const std::string& b_name) {
  if (a.width != b.width || a.height != b.height) {
    throw Error(ExitCode::bad_input, "{} has {} x {} pixels, {} has {} x {}; allowed: equal sizes",
                a_name, a.width, a.height, b_name, b.width, b.height);
  }
  if (a.windows != b.windows) {
    throw Error(ExitCode::bad_input, "{} has {} of {} x {}, {} has {}; allowed: the same pixels",
                a_name, pixels_in(a), a.width, a.height, b_name, pixels_in(b));
  }
  const std::size_t in_a = colour_channels(a, a_name).size(),
                    in_b = colour_channels(b, b_name).size();
  if (in_a != in_b) {
    throw Error(ExitCode::bad_input, "{} has {} colour channels, {} has {}; allowed: equal numbers",
                a_name, in_a, b_name, in_b);
  }
  if (a.encoding != b.encoding) {
    const bool a_linear = a.encoding == Encoding::linear;
    throw Error(ExitCode::bad_input,
                "{} has linear radiance, {} sRGB-encoded values; allowed: equal encodings",
                a_linear ? a_name : b_name, a_linear ? b_name : a_name);
  }
  check_finite(a, a_name);
  check_finite(b, b_name);
}

Comparison compare(const Image& a, const std::string& a_name, const Image& b,
                   const std::string& b_name, float exposure) {
  check_comparable(a, a_name, b, b_name);
  const std::vector<std::size_t> in_a = colour_channels(a, a_name),
                                 in_b = colour_channels(b, b_name);
  const std::vector<bool> valid_at = valid_pixels(a, b);
  const std::size_t pixels = a.pixel_count(), channels = in_a.size();

  Comparison result;
  result.width = a.width;
  result.height = a.height;
  result.channels = static_cast<int>(channels);
  result.encoding = a.encoding;
  Sums all, valid;
  double relative = 0;
  std::size_t present = 0;
  for (std::size_t p = 0; p < pixels; ++p) {
    if (!has_pixel(a, p)) continue;
    ++present;
    const float *pa = pixel(a, p), *pb = pixel(b, p);
    result.valid_pixels += valid_at[p];
    result.mean_luminance[0] += pixel_luminance(pa, in_a);
    result.mean_luminance[1] += pixel_luminance(pb, in_b);
    for (std::size_t c = 0; c < channels; ++c) {
      const double x = pa[in_a[c]], y = pb[in_b[c]], error = std::abs(x - y);
      all.add(x, y);
      if (valid_at[p]) valid.add(x, y);
      relative += error * error / (y * y + kRelativeFloor);
      if (error > result.max_error) {
        result.max_error = error;
        result.max_error_at = {static_cast<int>(p % a.width), static_cast<int>(p / a.width)};
      }
    }
  }
  const double values = static_cast<double>(present * channels);
  result.rmse = std::sqrt(all.squared_error / values);
  result.nrmse = normalised(all.squared_error, all.bb);
  result.relative_mse = relative / values;
  if (result.rmse > 0) result.psnr_db = -20 * std::log10(result.rmse);
  for (double& mean : result.mean_luminance) mean /= static_cast<double>(present);
  result.identical = result.max_error == 0;
  set_valid_errors(result, valid);
  double flips = 0;
  for (const double each : flip_map(a, b, exposure)) flips += each;
  result.flip = ratio(flips, static_cast<double>(result.valid_pixels));
  return result;
}

void require_valid_pixels(const Comparison& comparison, const std::string& a_name,
                          const std::string& b_name) {
  if (comparison.valid_pixels > 0) return;
  throw Error(ExitCode::validation,
              "{} and {}: found no pixel with alpha above 0 in both; allowed: one or more", a_name,
              b_name);
}

std::vector<double> flip_map(const Image& a, const Image& b, float exposure) {
  const std::vector<bool> valid = valid_pixels(a, b);
  std::vector<double> map = flip(shown(a, valid, exposure), shown(b, valid, exposure));
  for (std::size_t p = 0; p < valid.size(); ++p) {
    if (!valid[p]) map[p] = 0;
  }
  return map;
}

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Comparison, width, height, channels, rmse, nrmse, relative_mse,
                                   psnr_db, max_error, identical, valid_pixels, nrmse_valid,
                                   best_gain, nrmse_best_gain, energy_ratio, flip)

nlohmann::json to_json(const Comparison& c) {
  nlohmann::json json = c;
  json.update({{"schema", 1},
               {"encoding", c.encoding == Encoding::linear ? "linear" : "srgb"},
               {"max_error_at", c.max_error_at},
               {"mean_luminance", c.mean_luminance}});
  return json;
}

Image difference_image(const Image& a, const Image& b, float amplify) {
  const std::vector<std::size_t> in_a = colour_channels(a, {}), in_b = colour_channels(b, {});
  Image result = make_image(a.width, a.height, {"R", "G", "B"});
  result.encoding = a.encoding;
  for (std::size_t p = 0; p < a.pixel_count(); ++p) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t channel = in_a.size() < 3 ? 0 : c;
      result.pixels[3 * p + c] =
          amplify * std::abs(pixel(a, p)[in_a[channel]] - pixel(b, p)[in_b[channel]]);
    }
  }
  return result;
}

}  // namespace clpv
