// SPDX-License-Identifier: MIT
// Tone curves and sRGB encoding.
#include "image/tone_map.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <string_view>

#include "support/error.hpp"

namespace clpv {
namespace {
constexpr float kWhite = 6;  // smallest value that curve photographic shows as white
// Log-mean luminance of an automatically exposed image: just below middle grey, 0.18, since the few
// sunlit pixels of an interior are far brighter than its mean.
constexpr double kLogMean = 0.14;
constexpr std::array<std::string_view, 3> kNoLight{"albedo", "normal", "depth"};  // views
}  // namespace

float luminance(const glm::vec3& linear) {
  return 0.2126f * linear.r + 0.7152f * linear.g + 0.0722f * linear.b;
}

glm::vec3 tone_curve(ToneMap curve, const glm::vec3& linear) {
  // All curves are 1 at the upper bound, which avoids inf / inf.
  const glm::vec3 x = glm::clamp(linear, 0.0f, 1e6f);
  glm::vec3 mapped = x;
  switch (curve) {
    case ToneMap::none:
      break;
    case ToneMap::reinhard:
      mapped = x / (1.0f + luminance(x));
      break;
    case ToneMap::photographic:
      mapped = x * (1.0f + x / (kWhite * kWhite)) / (1.0f + x);
      break;
    case ToneMap::aces:
      mapped = (x * (2.51f * x + 0.03f)) / (x * (2.43f * x + 0.59f) + 0.14f);
      break;
  }
  return glm::clamp(mapped, 0.0f, 1.0f);
}

float srgb_encode(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

float srgb_decode(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

void require_linear(const char* name, const Image& image) {
  if (image.encoding != Encoding::linear)
    throw Error(ExitCode::bad_input, "{}: found sRGB-encoded values, allowed: linear ones", name);
}

void check_exposure(float exposure) {
  if (!std::isfinite(exposure))
    throw Error(ExitCode::usage, "exposure: found {}, allowed: a finite number", exposure);
}

float automatic_exposure(const Image& image) {
  check_image("image", image);
  const auto view = image.metadata.find("view");
  if (view != image.metadata.end() && std::ranges::count(kNoLight, view->second) > 0) return 0;
  const auto r = image.channel("R"), g = image.channel("G"), b = image.channel("B"),
             a = image.channel("A");
  if (!r || !g || !b || image.encoding != Encoding::linear) return 0;
  double sum = 0, lit = 0;
  for (std::size_t p = 0; p < image.pixel_count(); ++p) {
    const float* in = &image.pixels[p * image.channels.size()];
    const float light = luminance({in[*r], in[*g], in[*b]});
    if ((a && !(in[*a] > 0)) || !(light > 0) || !std::isfinite(light)) continue;
    sum += std::log2(static_cast<double>(light));
    lit += 1;
  }
  return lit > 0 ? static_cast<float>(std::log2(kLogMean) - sum / lit) : 0;
}

Image display_image(const Image& image, float exposure, ToneMap curve, Background background) {
  const auto r = image.channel("R"), g = image.channel("G"), b = image.channel("B"),
             a = image.channel("A");
  check_exposure(exposure);
  require_linear("image", image);
  if (!r || !g || !b)
    throw Error(ExitCode::bad_input, "image: found channels {}, allowed: R, G, B and optionally A",
                fmt::join(image.channels, ", "));
  const bool clear = a && background == Background::transparent;
  Image display = make_image(image.width, image.height, {"R", "G", "B"});
  if (clear) display = make_image(image.width, image.height, {"R", "G", "B", "A"});
  display.encoding = Encoding::srgb;
  display.metadata = image.metadata;
  const float gain = std::exp2(exposure);
  for (std::size_t p = 0; p < image.pixel_count(); ++p) {
    const float* in = &image.pixels[p * image.channels.size()];
    float* out = &display.pixels[p * display.channels.size()];
    const float alpha = a ? in[*a] : 1.0f;
    if (clear) out[3] = std::clamp(alpha, 0.0f, 1.0f);
    if (!(alpha > 0)) continue;
    const glm::vec3 colour = tone_curve(curve, gain * glm::vec3(in[*r], in[*g], in[*b]));
    for (int c = 0; c < 3; ++c) out[c] = srgb_encode(colour[c]);
  }
  return display;
}

}  // namespace clpv
