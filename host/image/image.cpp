// SPDX-License-Identifier: MIT
// Channels and layers of an image.

#include "image/image.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "kernels/shared/normal.h"
#include "support/error.hpp"
#include "support/fingerprint.hpp"

namespace clpv {
namespace {

std::string_view name_in_layer(std::string_view channel) {
  const auto dot = channel.rfind('.');
  return dot == std::string_view::npos ? channel : channel.substr(dot + 1);
}

bool has_colours(const Image& image, const std::string& layer) {
  return image.channel(layer + ".R") && image.channel(layer + ".G") && image.channel(layer + ".B");
}

/// Layers that a name may mean: itself, or that of a part; those with colours, if any have them.
std::vector<std::string> meant_layers(const Image& image, const std::string& layer) {
  const std::vector<std::string> all = layers(image);
  std::vector<std::string> found;
  if (std::ranges::count(all, layer) > 0) found.push_back(layer);
  for (const std::string& part : image.parts) {
    const std::string name = layer.empty() ? part : part + "." + layer;
    if (std::ranges::count(all, name) > 0) found.push_back(name);
  }
  if (std::ranges::any_of(found, [&](const auto& name) { return has_colours(image, name); }))
    std::erase_if(found, [&](const auto& name) { return !has_colours(image, name); });
  return found;
}

/// The layer itself, or that of the only part which has it; empty for none or several.
std::optional<std::string> found_layer(const Image& image, const std::string& layer) {
  const std::vector<std::string> all = layers(image), meant = meant_layers(image, layer);
  if (std::ranges::count(all, layer) > 0) return layer;
  return meant.size() == 1 ? std::optional(meant[0]) : std::nullopt;
}

}  // namespace

std::string_view layer_of(std::string_view channel) {
  const auto dot = channel.rfind('.');
  return dot == std::string_view::npos ? std::string_view{} : channel.substr(0, dot);
}

std::optional<std::size_t> Image::channel(std::string_view name) const {
  const auto channel = std::find(channels.begin(), channels.end(), name);
  if (channel == channels.end()) return std::nullopt;
  return static_cast<std::size_t>(channel - channels.begin());
}

void check_image(const std::string& name, const Image& image) {
  constexpr int kMaxSide = 16384;
  if (image.width < 1 || image.height < 1 || image.width > kMaxSide || image.height > kMaxSide)
    throw Error(ExitCode::bad_input, "{}: found {} x {} pixels, allowed: 1 to {} per side", name,
                image.width, image.height, kMaxSide);
  const std::size_t needed = image.pixel_count() * image.channels.size();
  if (needed == 0 || image.pixels.size() != needed)
    throw Error(ExitCode::bad_input,
                "{}: found {} numbers for {} x {} pixels of {} channels, allowed: {}", name,
                image.pixels.size(), image.width, image.height, image.channels.size(),
                needed == 0 ? "at least one channel" : std::to_string(needed));
  std::set<std::string_view> names;
  for (const std::string& channel : image.channels) {
    const bool printable =
        std::ranges::none_of(channel, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
    if (channel.empty() || !printable || !names.insert(channel).second)
      throw Error(ExitCode::bad_input,
                  "{}: found channels {}, allowed: unique names without control characters", name,
                  fmt::join(image.channels, ", "));
  }
}

Image make_image(int width, int height, std::vector<std::string> channels) {
  Image image;
  image.width = width;
  image.height = height;
  image.channels = std::move(channels);
  image.pixels.assign(image.pixel_count() * image.channels.size(), 0.0f);
  return image;
}

std::vector<std::string> layers(const Image& image) {
  std::vector<std::string> names;
  for (const std::string& channel : image.channels) {
    const std::string layer(layer_of(channel));
    if (std::find(names.begin(), names.end(), layer) == names.end()) names.push_back(layer);
  }
  return names;
}

Image extract_layer(const Image& image, const std::string& layer, const std::string& source) {
  const std::optional<std::string> found = found_layer(image, layer);
  std::vector<std::size_t> selected;
  std::vector<std::string> names;
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    if (layer_of(image.channels[c]) != found) continue;
    selected.push_back(c);
    names.emplace_back(name_in_layer(image.channels[c]));
  }
  if (selected.empty()) {
    std::vector<std::string> available;
    for (const std::string& name : layers(image)) available.push_back(fmt::format("'{}'", name));
    throw Error(ExitCode::bad_input, "{}: no layer '{}'; allowed: {}", source, layer,
                fmt::join(available, ", "));
  }
  Image result = make_image(image.width, image.height, std::move(names));
  result.metadata = image.metadata;
  result.encoding = image.encoding;
  result.notes = image.notes;
  for (const std::string& other : meant_layers(image, layer)) {
    if (other != *found)
      result.notes.push_back(fmt::format("layer '{}' is read, not '{}'", *found, other));
  }
  if (const auto window = image.windows.find(*found); window != image.windows.end())
    result.windows[""] = window->second;
  for (std::size_t p = 0; p < image.pixel_count(); ++p) {
    for (std::size_t c = 0; c < selected.size(); ++c) {
      result.pixels[p * selected.size() + c] =
          image.pixels[p * image.channels.size() + selected[c]];
    }
  }
  return result;
}

void append_layer(Image& image, const Image& addition, const std::string& layer) {
  if (image.channels.empty()) {
    image.width = addition.width;
    image.height = addition.height;
    image.encoding = addition.encoding;
  }
  if (image.width != addition.width || image.height != addition.height ||
      image.encoding != addition.encoding) {
    throw std::logic_error("layers of an image must have equal sizes and encodings");
  }
  const std::size_t before = image.channels.size(), added = addition.channels.size();
  std::vector<float> pixels(image.pixel_count() * (before + added));
  for (std::size_t p = 0; p < image.pixel_count(); ++p) {
    const auto out = std::copy_n(image.pixels.begin() + p * before, before,
                                 pixels.begin() + p * (before + added));
    std::copy_n(addition.pixels.begin() + p * added, added, out);
  }
  image.pixels = std::move(pixels);
  for (const std::string& name : addition.channels) {
    image.channels.push_back(layer.empty() ? name : layer + "." + name);
  }
}

std::uint8_t byte_of(float value) {
  const float clamped = value > 0 ? std::min(value, 1.0f) : 0.0f;
  return static_cast<std::uint8_t>(std::lround(clamped * 255.0f));
}

void add_pixels(Fingerprint& print, const Image& image) {
  print.add(image.width).add(image.height);
  std::map<std::string, std::size_t> sorted;  // files order channels by name
  for (const std::string& name : image.channels) sorted[name] = *image.channel(name);
  for (const auto& [name, channel] : sorted) {
    std::vector<float> values(image.pixel_count());
    for (std::size_t i = 0; i < values.size(); ++i) {
      const float value = image.pixels[i * image.channels.size() + channel];
      values[i] = image.encoding == Encoding::srgb ? static_cast<float>(byte_of(value)) : value;
    }
    print.add(name).add(values);
  }
}

namespace {

constexpr double kSteps = CLPV_NORMAL_STEPS, kZero = CLPV_NORMAL_ZERO, kBase = CLPV_NORMAL_BASE;

/// Folds the lower half of the octahedron over the upper one, and back.
glm::dvec2 fold(const glm::dvec2& at) {
  return {std::copysign(1 - std::abs(at.y), at.x), std::copysign(1 - std::abs(at.x), at.y)};
}

}  // namespace

glm::dvec3 geometric_normal(const glm::vec4& normal) {
  if (!(normal.w > 0)) return glm::dvec3(normal);
  const double row = std::floor(double{normal.w} / kBase);
  glm::dvec2 at((double{normal.w} - kBase * row - kZero) / kSteps, (row - kZero) / kSteps);
  const double z = 1 - std::abs(at.x) - std::abs(at.y);
  if (z < 0) at = fold(at);
  return glm::normalize(glm::dvec3(at, z));
}

glm::dvec3 lift_normal(const glm::dvec3& shading, const glm::dvec3& geometric) {
  return glm::dot(shading, geometric) > double{CLPV_SAME_LIFT} ? shading : geometric;
}

glm::dvec3 lift_normal(const glm::vec4& normal) {
  return lift_normal(glm::dvec3(normal), geometric_normal(normal));
}

glm::vec4 stored_normal(const glm::dvec3& shading, const glm::dvec3& geometric) {
  if (glm::dot(shading, geometric) > double{CLPV_SAME_NORMAL}) return {glm::vec3(shading), 0.0f};
  const glm::dvec3 on =
      geometric / (std::abs(geometric.x) + std::abs(geometric.y) + std::abs(geometric.z));
  const glm::dvec2 at = on.z < 0 ? fold(glm::dvec2(on)) : glm::dvec2(on);
  const glm::dvec2 steps = glm::roundEven(kSteps * at) + kZero;
  return {glm::vec3(shading), static_cast<float>(steps.x + kBase * steps.y)};
}

}  // namespace clpv
