// SPDX-License-Identifier: MIT
// Walks through the headers of an OpenEXR file: magic number, version and flags, then per part a
// list of attributes. OpenEXR reads them again. What it checks is not checked here.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <string_view>

#include "image/image_header.hpp"
#include "support/array_files.hpp"
#include "support/error.hpp"
#include "support/input_file.hpp"

namespace clpv {
namespace {

// In the version.
constexpr std::uint32_t kTiledFlag = 0x200, kDeepFlag = 0x800, kMultiPartFlag = 0x1000;
constexpr std::size_t kFlagsAt = 4;
constexpr std::size_t kNameBytes = 255;
constexpr std::string_view kMetadataPrefix = "clpv:";
constexpr std::size_t kMaxParts = 1024, kMaxAttributes = 1024;  // OpenImageIO's time is quadratic
constexpr std::array<std::string_view, 4> kPartTypes = {
    {"scanlineimage", "tiledimage", "deepscanline", "deeptile"}};
/// Rows of a chunk by compression: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB.
constexpr std::array<std::int64_t, 10> kChunkRows = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};

/// Reader of bytes that rejects reads beyond their end.
class Cursor {
 public:
  Cursor(std::string file, std::span<const unsigned char> bytes)
      : file_(std::move(file)), left_(bytes) {}

  std::size_t left() const { return left_.size(); }
  const std::string& file() const { return file_; }

  /// Returns the next `count` bytes and advances.
  std::span<const unsigned char> take(std::size_t count, std::string_view place) {
    if (count > left_.size()) {
      reject(file_, place, fmt::format("{} bytes", count),
             fmt::format("the {} bytes left", left_.size()));
    }
    const auto taken = left_.first(count);
    left_ = left_.subspan(count);
    return taken;
  }

  template <typename Number = std::uint32_t>
  Number number(std::string_view place) {
    return little_endian<Number>(take(sizeof(Number), place), 0);
  }

  /// Returns the text up to the next NUL and advances past the NUL.
  std::string name(std::string_view place) {
    const auto window = left_.first(std::min(left_.size(), kNameBytes + 1));
    const auto end = std::ranges::find(window, 0);
    if (end == window.end()) {
      reject(file_, place, fmt::format("no end of a name in {} bytes", window.size()),
             fmt::format("names of up to {} bytes", kNameBytes));
    }
    const auto taken = take(static_cast<std::size_t>(end - window.begin()) + 1, place);
    return {taken.begin(), taken.end() - 1};
  }

 private:
  std::string file_;
  std::span<const unsigned char> left_;
};

/// Header of one part, and what only the walk needs.
struct ExrPart : ExrHeader {
  std::int64_t rows = 1;                         ///< rows of a chunk of a part without tiles
  std::int64_t tile_width = 0, tile_height = 0;  ///< 0 without attribute `tiles`
  std::string type;
  std::size_t attributes = 0;
};

/// Reads the entries of a channel list: names, each followed by type and sampling, ended by an
/// empty name. Rejects channels of less resolution, and names that are not unique and sorted:
/// OpenImageIO does not end with two of one name, and values of others may be in either order.
void read_channels(ExrPart& part, Cursor list, std::string_view place) {
  constexpr std::size_t kTypeBytes = 8;
  constexpr std::uint32_t kFloat = 2;
  std::vector<std::string>& names = part.channel_names;
  for (std::string name; !(name = list.name(place)).empty(); names.push_back(name)) {
    if (!names.empty() && name <= names.back())
      reject(list.file(), place, fmt::format("channel '{}' after '{}'", name, names.back()),
             "unique names in alphabetical order");
    const auto type = little_endian(list.take(kTypeBytes, place), 0);
    part.floats = part.floats && type == kFloat;
    const auto x = list.number(place), y = list.number(place);
    if (x != 1 || y != 1) {
      reject(list.file(), place,
             fmt::format("channel '{}' sampled every {} x {} pixels", name, x, y), "1 x 1");
    }
  }
  part.channels = static_cast<std::int64_t>(names.size());
}

ExrWindow read_window(Cursor& value, std::string_view place) {
  ExrWindow window;
  for (std::int64_t* side : {&window.left, &window.top, &window.right, &window.bottom})
    *side = value.number<std::int32_t>(place);
  return window;
}

/// Stores the attributes that determine memory use, places and colours of pixels.
void store_value(ExrPart& part, Cursor value, std::string_view place, std::string_view name,
                 std::string_view type) {
  const auto text = [&] {
    const auto bytes = value.take(value.left(), place);
    return std::string(bytes.begin(), bytes.end());
  };
  if (name == "dataWindow" && type == "box2i") {
    part.data = read_window(value, place);
    part.width = part.data.width(), part.height = part.data.height();
  } else if (name == "displayWindow" && type == "box2i") {
    part.display = read_window(value, place);
  } else if (name == "chromaticities" && type == "chromaticities") {
    for (double& number : part.chromaticities.emplace())
      number = double{std::bit_cast<float>(value.number(place))};
  } else if (name == "envmap" && type == "envmap") {
    part.cube_map = value.take(1, place)[0] == 1;
  } else if (name == "name" && type == "string") {
    part.name = text();
  } else if (name == "tiles" && type == "tiledesc") {
    part.tile_width = value.number(place), part.tile_height = value.number(place);
  } else if (name == "compression" && type == "compression") {
    part.compression = value.take(1, place)[0];
    part.rows = kChunkRows[std::min<std::size_t>(part.compression, kChunkRows.size() - 1)];
  } else if (name == "type" && type == "string") {
    part.type = text();
  } else if (name == "channels" && type == "chlist") {
    if (part.channels != 0) reject(value.file(), place, "a second list of channels", "one");
    read_channels(part, value, place);
  } else if (name.starts_with(kMetadataPrefix) && type == "string") {
    part.metadata[std::string(name.substr(kMetadataPrefix.size()))] = text();
  }
}

/// Reads one header: attributes, each with name, type, size and value, ended by an empty name.
ExrPart read_part(Cursor& file, std::size_t index) {
  ExrPart part;
  const std::string part_place = fmt::format("part {}", index);
  for (;; ++part.attributes) {
    const std::string name = file.name(part_place);
    if (name.empty()) return part;
    const std::string type = file.name(fmt::format("{}, attribute '{}'", part_place, name));
    const std::string place = fmt::format("{}, attribute '{}' ({})", part_place, name, type);
    const auto bytes = file.take(file.number(place), place);
    if (part.attributes == kMaxAttributes) {
      reject(file.file(), part_place, fmt::format("over {} attributes", kMaxAttributes),
             fmt::format("up to {}", kMaxAttributes));
    }
    store_value(part, Cursor(file.file(), bytes), place, name, type);
  }
}

/// Sets the size of a part's chunks, once all its attributes are known.
void set_chunk_size(ExrPart& part, std::uint32_t flags, bool typed) {
  part.deep = typed && part.type.starts_with("deep");
  part.tiled =
      typed ? part.type == "deeptile" || part.type == "tiledimage" : (flags & kTiledFlag) != 0;
  part.chunk_width = part.tiled ? part.tile_width : part.width;
  part.chunk_height = part.tiled ? part.tile_height : part.rows;
}

}  // namespace

std::vector<ExrHeader> read_exr_header(const std::filesystem::path& path,
                                       std::span<const unsigned char> bytes) {
  Cursor file(path.string(), bytes);
  file.take(kFlagsAt, "the header");
  const std::uint32_t flags = file.number("the header");
  const bool several = (flags & kMultiPartFlag) != 0, typed = several || (flags & kDeepFlag) != 0;
  std::vector<ExrHeader> parts;
  for (std::size_t index = 0;; ++index) {
    ExrPart part = read_part(file, index);
    if (several && part.attributes == 0) break;  // an empty header ends the list of parts
    // Files with several or deep parts declare types; OpenEXR does not check parts of other types,
    // and OpenImageIO 2.4 crashes on their headers.
    if (typed && std::ranges::count(kPartTypes, part.type) == 0)
      reject(file.file(), fmt::format("part {}", index), fmt::format("type '{}'", part.type),
             fmt::format("{}", fmt::join(kPartTypes, ", ")));
    set_chunk_size(part, flags, typed);
    part.end = bytes.size() - file.left();
    if (part.display == ExrWindow{}) part.display = part.data;
    parts.push_back(part);
    if (index == kMaxParts)
      reject(file.file(), {}, fmt::format("over {} parts", index),
             fmt::format("up to {}", kMaxParts));
    if (!several) break;
  }
  return parts;
}

}  // namespace clpv
