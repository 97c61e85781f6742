// SPDX-License-Identifier: MIT
// Pixels of EXR files: parts, windows and primaries.
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "image/image_header.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

std::string text_of(const ExrWindow& window) {
  return fmt::format("({}, {}) to ({}, {})", window.left, window.top, window.right, window.bottom);
}

/// Common part of the data window and a display window that has pixels, from the latter's corner.
PixelWindow shown_window(const ExrHeader& part) {
  const ExrWindow &data = part.data, &display = part.display;
  const auto clamped = [](std::int64_t at, std::int64_t size) {
    return static_cast<int>(std::clamp<std::int64_t>(at, 0, size));
  };
  return {.left = clamped(data.left - display.left, display.width()),
          .top = clamped(data.top - display.top, display.height()),
          .right = clamped(data.right + 1 - display.left, display.width()),
          .bottom = clamped(data.bottom + 1 - display.top, display.height())};
}

void check_part(const fs::path& path, const ExrHeader& part, const ExrHeader& first,
                const ImageLimits& limits) {
  check_size(path, part, limits);
  check_size(path, {.width = part.display.width(), .height = part.display.height(), .channels = 1},
             limits);
  if (part.cube_map)
    reject_image(path, "found a cube map (attribute 'envmap' 1); allowed: flat images");
  if (part.display != first.display) {
    reject_image(path,
                 fmt::format("part '{}': found the display window {}; allowed: {}, as the first "
                             "part's",
                             part.name, text_of(part.display), text_of(first.display)));
  }
  const PixelWindow shown = shown_window(part);
  if (shown.left >= shown.right || shown.top >= shown.bottom) {
    reject_image(path, fmt::format("found the data window {} outside the display window {}; "
                                   "allowed: windows that overlap",
                                   text_of(part.data), text_of(part.display)));
  }
}

/// Checks all parts, and the size of the image that they make.
void check_parts(const fs::path& path, const std::vector<ExrHeader>& parts,
                 const ImageLimits& limits) {
  if (parts.empty()) reject_image(path, "found no parts; allowed: 1 or more");
  DeclaredImage all{.width = parts[0].display.width(), .height = parts[0].display.height()};
  std::set<std::string> names;
  for (const ExrHeader& part : parts) {
    check_part(path, part, parts[0], limits);
    all.channels += part.channels;
    if (parts.size() > 1 && (part.name.empty() || !names.insert(part.name).second)) {
      reject_image(path,
                   fmt::format("found two parts of the name '{}', or none; allowed: unique names",
                               part.name));
    }
  }
  check_size(path, all, limits);
}

/// Copies what the display window shows of a part's pixels into channels from `first` on.
void place(const ExrHeader& part, const Image& from, Image& to, std::size_t first) {
  const PixelWindow shown = shown_window(part);
  const auto x = static_cast<int>(part.display.left - part.data.left),
             y = static_cast<int>(part.display.top - part.data.top);
  for (int row = shown.top; row < shown.bottom; ++row) {
    for (int column = shown.left; column < shown.right; ++column) {
      for (std::size_t c = 0; c < from.channels.size(); ++c)
        to.at(column, row, first + c) = from.at(column + x, row + y, c);
    }
  }
}

}  // namespace

void convert_primaries(const fs::path& path, Image& image, const Chromaticities& chromaticities) {
  if (is_rec709(chromaticities)) return;
  const std::string text = fmt::format("chromaticities {}", text_of(chromaticities));
  const auto matrix = to_rec709(chromaticities);
  if (!matrix)
    reject_image(path, fmt::format("found {}; allowed: three colours and a white", text));
  for (const std::string& layer : layers(image)) {
    const std::string prefix = layer.empty() ? "" : layer + ".";
    const auto r = image.channel(prefix + "R"), g = image.channel(prefix + "G"),
               b = image.channel(prefix + "B");
    if (!r || !g || !b) continue;
    for (std::size_t p = 0; p < image.pixel_count(); ++p) {
      float* pixel = &image.pixels[p * image.channels.size()];
      const glm::vec3 converted(*matrix * glm::dvec3(pixel[*r], pixel[*g], pixel[*b]));
      pixel[*r] = converted.x, pixel[*g] = converted.y, pixel[*b] = converted.z;
    }
    const std::string note = text + ": converted to Rec. 709";
    if (std::ranges::count(image.notes, note) == 0) image.notes.push_back(note);
  }
}

ExrFile::ExrFile(const fs::path& path, std::span<const std::uint8_t> bytes,
                 const ImageLimits& limits)
    : path_(path), limits_(limits), parts_(read_exr_header(path, bytes)) {
  check_parts(path, parts_, limits);
  decoder_ = open_decoder(path, "openexr", bytes, limits);
}

const std::map<std::string, std::string>& ExrFile::metadata() const {
  return decoder_->described().metadata;
}

/// Turns to a part, whose size must be that of its header.
const CodedImage& ExrFile::open_part(std::size_t index) {
  if (const std::string error = decoder_->select(static_cast<int>(index)); !error.empty())
    reject_image(path_, fmt::format("part {}: cannot be read: {}", index, error));
  const CodedImage& coded = decoder_->described();
  check_declared(path_, coded, limits_);
  if (coded.width != parts_[index].width || coded.height != parts_[index].height) {
    reject_image(
        path_,
        fmt::format("part {}: damaged: {} x {} pixels in its header, {} x {} in its "
                    "decoder",
                    index, parts_[index].width, parts_[index].height, coded.width, coded.height));
  }
  return coded;
}

/// Pixels of a part's data window.
Image ExrFile::decode_part(std::size_t index) {
  const CodedImage& coded = open_part(index);
  Image image = make_image(coded.width, coded.height, coded.channels);
  if (index == 0) image.metadata = coded.metadata;
  read_pixels(path_, *decoder_, image.pixels.data());
  if (const auto& primaries = parts_[index].chromaticities)
    convert_primaries(path_, image, *primaries);
  return image;
}

/// Names of the channels of all parts; several parts are layers. Rejects a part and a layer of one
/// name: `a.b.R` may be R of part a.b, or b.R of part a.
std::vector<std::string> ExrFile::channel_names() {
  std::vector<std::string> names;
  std::set<std::string> unique;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const std::string layer = parts_.size() > 1 ? parts_[i].name + "." : "";
    for (const std::string& channel : open_part(i).channels) {
      names.push_back(channel.starts_with(layer) ? channel : layer + channel);
      if (!unique.insert(names.back()).second) {
        reject_image(path_, fmt::format("part '{}', channel '{}': found {} twice; allowed: unique "
                                        "names of parts and layers",
                                        parts_[i].name, channel, names.back()));
      }
    }
  }
  return names;
}

Image ExrFile::decode() {
  const ExrWindow& display = parts_[0].display;
  const PixelWindow all{.left = 0,
                        .top = 0,
                        .right = static_cast<int>(display.width()),
                        .bottom = static_cast<int>(display.height())};
  if (parts_.size() == 1 && parts_[0].data == display) return decode_part(0);
  Image image = make_image(all.right, all.bottom, channel_names());
  std::size_t channel = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Image part = decode_part(i);
    if (i == 0) image.metadata = part.metadata;
    if (parts_.size() > 1) image.parts.push_back(parts_[i].name);
    for (const std::string& note : part.notes)
      if (std::ranges::count(image.notes, note) == 0) image.notes.push_back(note);
    place(parts_[i], part, image, channel);
    const auto names = std::span(image.channels).subspan(channel, part.channels.size());
    if (shown_window(parts_[i]) != all) {
      for (const std::string& name : names)
        image.windows[std::string(layer_of(name))] = shown_window(parts_[i]);
    }
    channel += part.channels.size();
  }
  return image;
}

}  // namespace clpv
