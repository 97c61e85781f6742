#include "report/picture.hpp"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>

#include "image/image_io.hpp"
#include "image/tone_map.hpp"

namespace clpv::report {
namespace {

const char* const kColours = "inferno";  // dark to light in print, and for eyes that see no red or no green

/// RFC 4648.
std::string base64(const std::vector<unsigned char>& bytes) {
  static const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i) group = group << 8 | (i < left ? bytes[at + i] : 0u);
    for (std::size_t i = 0; i < 4; ++i) text += i <= left ? digits[group >> (18 - 6 * i) & 63] : '=';
  }
  return text;
}

/// Values in [0, 1] as colours; `shares` has one channel.
Image coloured(const Image& shares) {
  const OIIO::ImageBuf values(OIIO::ImageSpec(shares.width, shares.height, 1, OIIO::TypeFloat),
                              const_cast<float*>(shares.pixels.data()));
  const OIIO::ImageBuf mapped = OIIO::ImageBufAlgo::color_map(values, 0, kColours);
  Image image = make_image(shares.width, shares.height, {"R", "G", "B"});
  image.encoding = Encoding::srgb;
  mapped.get_pixels(mapped.roi(), OIIO::TypeFloat, image.pixels.data());
  return image;
}

glm::vec3 colour_at(const Image& image, int x, int y) {
  return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

bool covered(const Image& image, int x, int y) {
  const auto alpha = image.channel("A");
  return !alpha || image.at(x, y, *alpha) > 0;
}

}  // namespace

std::string data_uri(const Image& shown) {
  return "data:image/png;base64," + base64(png_bytes(shown));
}

Image false_colour(const Image& image, const Image& truth, double full_scale) {
  double squares = 0, count = 0;
  for (int y = 0; y < truth.height; ++y) {
    for (int x = 0; x < truth.width; ++x) {
      if (!covered(truth, x, y)) continue;
      const double l = luminance(colour_at(truth, x, y));
      squares += l * l, count += 1;
    }
  }
  const double rms = count > 0 ? std::sqrt(squares / count) : 0;
  Image shares = make_image(truth.width, truth.height, {"Y"});
  for (int y = 0; y < truth.height; ++y) {
    for (int x = 0; x < truth.width; ++x) {
      const double error = luminance(glm::abs(colour_at(image, x, y) - colour_at(truth, x, y)));
      shares.at(x, y, 0) = rms > 0 ? static_cast<float>(std::min(1.0, error / (rms * full_scale))) : 0;
    }
  }
  const Image colours = coloured(shares);
  Image result = make_image(truth.width, truth.height, {"R", "G", "B", "A"});
  result.encoding = Encoding::srgb;
  for (int y = 0; y < truth.height; ++y) {
    for (int x = 0; x < truth.width; ++x) {
      const bool shows = covered(truth, x, y) && covered(image, x, y);
      for (std::size_t c = 0; c < 3; ++c) result.at(x, y, c) = shows ? colours.at(x, y, c) : 0;
      result.at(x, y, 3) = shows ? 1 : 0;
    }
  }
  return result;
}

Image legend(int width, int height) {
  Image shares = make_image(width, height, {"Y"});
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      shares.at(x, y, 0) = static_cast<float>(x) / static_cast<float>(std::max(1, width - 1));
  }
  return coloured(shares);
}

}  // namespace clpv::report
