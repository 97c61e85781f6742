// SPDX-License-Identifier: MIT
// Walks through the headers of an OpenEXR file: magic number, version and flags, then per part a
// list of attributes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <set>
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
constexpr std::size_t kMaxParts = 1024, kMaxAttributes = 1024;  // bound the time of the walk
constexpr std::int64_t kOffsetBytes = 8;                        // an entry in the table of chunks
constexpr unsigned char kCubeMap = 1;                           // value of `envmap`
constexpr std::array<std::string_view, 4> kPartTypes = {
    {"scanlineimage", "tiledimage", "deepscanline", "deeptile"}};

struct FixedSize {
  std::string_view type;
  std::size_t bytes;
};

/// Types with fixed sizes. OpenEXR ignores the size in the file: with another size it would read on
/// from another offset.
constexpr std::array<FixedSize, 24> kFixedSizes = {{
    {"box2f", 16},
    {"box2i", 16},
    {"chromaticities", 32},
    {"compression", 1},
    {"deepImageState", 1},
    {"double", 8},
    {"envmap", 1},
    {"float", 4},
    {"int", 4},
    {"keycode", 28},
    {"lineOrder", 1},
    {"m33d", 72},
    {"m33f", 36},
    {"m44d", 128},
    {"m44f", 64},
    {"rational", 8},
    {"tiledesc", 9},
    {"timecode", 8},
    {"v2d", 16},
    {"v2f", 8},
    {"v2i", 8},
    {"v3d", 24},
    {"v3f", 12},
    {"v3i", 12},
}};

/// Rows of a chunk by compression: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB.
constexpr std::array<std::int64_t, 10> kChunkRows = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};

std::int32_t number_at(std::span<const unsigned char> bytes, std::size_t at) {
  return little_endian<std::int32_t>(bytes, at);
}

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

  std::uint32_t number(std::string_view place) { return little_endian(take(4, place), 0); }

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
  std::int64_t chunks = 0;                       ///< value of `chunkCount`
  bool compressed = true;
  std::int64_t pixel_bytes = 0;  ///< sum over all channels
  std::string type;
  bool empty = true;  ///< true without attributes
};

struct ChannelList {
  std::int64_t count = 0, pixel_bytes = 0;
};

/// Reads the entries of a channel list: names, each followed by 16 bytes of type and sampling,
/// ended by an empty name. Rejects channels of less resolution, bytes after the end, and names that
/// are not sorted: the values of such files may be in either order.
ChannelList read_channels(Cursor list, std::string_view place) {
  constexpr std::size_t kChannelBytes = 16, kSamplingAt = 8;
  constexpr std::int32_t kHalf = 1;
  ChannelList found;
  std::string before;
  for (std::string name; !(name = list.name(place)).empty(); before = name, ++found.count) {
    if (name <= before)
      reject(list.file(), place, fmt::format("channel '{}' after '{}'", name, before),
             "unique names in alphabetical order");
    const auto bytes = list.take(kChannelBytes, place);
    found.pixel_bytes += number_at(bytes, 0) == kHalf ? 2 : 4;
    const std::int32_t x = number_at(bytes, kSamplingAt), y = number_at(bytes, kSamplingAt + 4);
    if (x != 1 || y != 1) {
      reject(list.file(), place,
             fmt::format("channel '{}' sampled every {} x {} pixels", name, x, y), "1 x 1");
    }
  }
  if (list.left() != 0) {
    reject(list.file(), place, fmt::format("{} bytes after the last channel", list.left()), "none");
  }
  return found;
}

/// Rejects a preview whose width and height do not match its size: OpenEXR trusts width and height.
void check_preview(const Cursor& file, std::string_view place,
                   std::span<const unsigned char> bytes) {
  constexpr std::size_t kPixelsAt = 8, kPixelBytes = 4;
  if (bytes.size() < kPixelsAt)
    reject(file.file(), place, fmt::format("{} bytes", bytes.size()), "width, height and pixels");
  const std::int64_t width = number_at(bytes, 0), height = number_at(bytes, 4);
  const std::size_t pixels = (bytes.size() - kPixelsAt) / kPixelBytes;
  const bool whole = bytes.size() == kPixelsAt + kPixelBytes * pixels;
  if (!whole || width < 0 || height < 0 || width * height != static_cast<std::int64_t>(pixels)) {
    reject(file.file(), place,
           fmt::format("{} x {} pixels in {} bytes", width, height, bytes.size() - kPixelsAt),
           "4 bytes per pixel");
  }
}

/// Rejects texts, each preceded by its length, that exceed the attribute.
void check_texts(Cursor list, std::string_view place) {
  while (list.left() > 0) list.take(list.number(place), place);
}

/// Rejects a value whose size does not match its type or its contents.
void check_value(const Cursor& file, std::string_view place, std::string_view type,
                 std::span<const unsigned char> bytes) {
  const auto fixed = std::ranges::find(kFixedSizes, type, &FixedSize::type);
  if (fixed != kFixedSizes.end() && fixed->bytes != bytes.size()) {
    reject(file.file(), place, fmt::format("{} bytes", bytes.size()),
           fmt::format("{}", fixed->bytes));
  }
  if (type == "preview") check_preview(file, place, bytes);
  if (type == "stringvector") check_texts(Cursor(file.file(), bytes), place);
  if (type == "floatvector" && bytes.size() % 4 != 0) {
    reject(file.file(), place, fmt::format("{} bytes", bytes.size()), "4 per number");
  }
}

ExrWindow window_at(std::span<const unsigned char> bytes) {
  return {number_at(bytes, 0), number_at(bytes, 4), number_at(bytes, 8), number_at(bytes, 12)};
}

Chromaticities chromaticities_at(std::span<const unsigned char> bytes) {
  Chromaticities found;
  for (std::size_t i = 0; i < found.size(); ++i)
    found[i] = double{std::bit_cast<float>(little_endian(bytes, 4 * i))};
  return found;
}

/// Stores the attributes that determine memory use, places and colours of pixels.
void store_value(ExrPart& part, const Cursor& file, std::string_view place, std::string_view name,
                 std::string_view type, std::span<const unsigned char> bytes) {
  if (name == "dataWindow" && type == "box2i") {
    part.data = window_at(bytes);
    part.width = part.data.width(), part.height = part.data.height();
  } else if (name == "displayWindow" && type == "box2i") {
    part.display = window_at(bytes);
  } else if (name == "chromaticities" && type == "chromaticities") {
    part.chromaticities = chromaticities_at(bytes);
  } else if (name == "envmap" && type == "envmap") {
    part.cube_map = bytes[0] == kCubeMap;
  } else if (name == "name" && type == "string") {
    part.name.assign(bytes.begin(), bytes.end());
  } else if (name == "tiles" && type == "tiledesc") {
    part.tile_width = little_endian(bytes, 0);
    part.tile_height = little_endian(bytes, 4);
  } else if (name == "compression" && type == "compression") {
    part.rows = kChunkRows[std::min<std::size_t>(bytes[0], kChunkRows.size() - 1)];
    part.compressed = bytes[0] != 0;
  } else if (name == "chunkCount" && type == "int") {
    part.chunks = number_at(bytes, 0);
  } else if (name == "type" && type == "string") {
    part.type.assign(bytes.begin(), bytes.end());
  }
  if (type == "chlist") {
    const ChannelList found = read_channels(Cursor(file.file(), bytes), place);
    if (name == "channels") part.channels = found.count, part.pixel_bytes = found.pixel_bytes;
  }
}

/// Reads one header: attributes, each with name, type, size and value, ended by an empty name.
ExrPart read_part(Cursor& file, std::size_t index) {
  ExrPart part;
  std::set<std::string> names;
  for (;; part.empty = false) {
    const std::string part_place = fmt::format("part {}", index);
    const std::string name = file.name(part_place);
    if (name.empty()) return part;
    const std::string type = file.name(fmt::format("{}, attribute '{}'", part_place, name));
    const std::string place = fmt::format("{}, attribute '{}' ({})", part_place, name, type);
    const auto bytes = file.take(file.number(place), place);
    if (names.size() == kMaxAttributes) {
      reject(file.file(), part_place, fmt::format("over {} attributes", names.size()),
             fmt::format("up to {}", kMaxAttributes));
    }
    // OpenEXR would add a second list of channels to the first.
    if (!names.insert(name).second)
      reject(file.file(), place, "a duplicate attribute", "unique names");
    check_value(file, place, type, bytes);
    store_value(part, file, place, name, type, bytes);
  }
}

/// Minimum number of chunks of a part, without its mip levels.
std::int64_t min_chunks(const ExrPart& part) {
  const auto quotient_up = [](std::int64_t count, std::int64_t by) {
    return by > 0 && count > 0 ? (count + by - 1) / by : 0;
  };
  const std::int64_t rows = quotient_up(part.height, part.chunk_height);
  if (!part.tiled) return std::max(part.chunks, rows);
  constexpr std::int64_t kMax = 1ll << 31;  // avoids overflow of the product
  const std::int64_t columns = quotient_up(part.width, part.chunk_width);
  return std::max(part.chunks, std::min(rows, kMax) * std::min(columns, kMax));
}

/// Rejects a part of unknown type. Files with several or deep parts declare types; OpenEXR does not
/// check parts of other types, and OpenImageIO 2.4 crashes on their headers.
void check_type(const Cursor& file, const std::string& place, const ExrPart& part) {
  if (std::ranges::count(kPartTypes, part.type) > 0) return;
  reject(file.file(), place, fmt::format("type '{}'", part.type),
         fmt::format("{}", fmt::join(kPartTypes, ", ")));
}

/// Sets the size of a part's chunks, once all its attributes are known.
void set_chunk_size(ExrPart& part, std::uint32_t flags, bool typed) {
  part.deep = typed && part.type.starts_with("deep");
  part.tiled =
      typed ? part.type == "deeptile" || part.type == "tiledimage" : (flags & kTiledFlag) != 0;
  part.chunk_width = part.tiled ? part.tile_width : part.width;
  part.chunk_height = part.tiled ? part.tile_height : part.rows;
}

/// Rejects rows without compression that are shorter or longer than their pixels: OpenEXR fills
/// them up. `table`: offset of the offsets of chunks in the file, of one part.
void check_chunks(const std::string& file, std::span<const unsigned char> bytes, std::size_t table,
                  const ExrPart& part) {
  constexpr std::size_t kSizeAt = 4, kPixelsAt = 8;
  if (part.compressed || part.tiled || part.deep) return;
  for (std::int64_t row = 0; row < part.height; ++row) {
    const std::size_t at = table + static_cast<std::size_t>(row * kOffsetBytes);
    const auto offset = little_endian<std::uint64_t>(bytes, at);
    // OpenEXR recovers missing offsets, and rejects those behind the end.
    if (offset == 0 || offset > bytes.size() || bytes.size() - offset < kPixelsAt) continue;
    const std::int64_t size = number_at(bytes, offset + kSizeAt),
                       expected = part.width * part.pixel_bytes;
    if (size != expected)
      reject(file, fmt::format("row {}", row), fmt::format("{} bytes", size),
             fmt::format("{}", expected));
  }
}

}  // namespace

std::vector<ExrHeader> read_exr_header(const std::filesystem::path& path,
                                       std::span<const unsigned char> bytes) {
  Cursor file(path.string(), bytes);
  file.take(kFlagsAt, "the header");
  const std::uint32_t flags = file.number("the header");
  const bool several = (flags & kMultiPartFlag) != 0, typed = several || (flags & kDeepFlag) != 0;
  // The tables of chunks of all parts follow the last header.
  const auto check_tables = [&](const std::string& place, std::int64_t chunks) {
    const std::int64_t max_chunks = static_cast<std::int64_t>(file.left()) / kOffsetBytes;
    if (chunks <= max_chunks) return;
    reject(file.file(), place, fmt::format("{} chunks", chunks),
           fmt::format("{}, whose table fits into the rest of the file", max_chunks));
  };
  std::vector<ExrHeader> parts;
  std::int64_t chunks = 0;
  for (std::size_t index = 0;; ++index) {
    ExrPart part = read_part(file, index);
    if (several && part.empty) break;  // an empty header ends the list of parts
    if (typed) check_type(file, fmt::format("part {}", index), part);
    set_chunk_size(part, flags, typed);
    if (part.display == ExrWindow{}) part.display = part.data;
    parts.push_back(part);
    if (index == kMaxParts)
      reject(file.file(), {}, fmt::format("over {} parts", index),
             fmt::format("up to {}", kMaxParts));
    check_tables(fmt::format("part {}", index), min_chunks(part));
    chunks += min_chunks(part);
    if (!several) check_chunks(file.file(), bytes, bytes.size() - file.left(), part);
    if (!several) break;
  }
  check_tables("all parts", chunks);
  return parts;
}

}  // namespace clpv
