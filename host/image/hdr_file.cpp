// SPDX-License-Identifier: MIT
// Radiance pictures: a header of lines, a line of resolution and orientation, and scanlines of RGBE
// pixels, run-length encoded in the new way, the old way, or not at all.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <string_view>

#include "image/image_header.hpp"
#include "support/error.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFormat = "32-bit_rle_rgbe";
constexpr std::size_t kPixelBytes = 4;
constexpr std::size_t kMinRunWidth = 8,
                      kMaxRunWidth = 0x7fff;  // scanlines that may be run-length encoded
constexpr int kExponentBias = 128 + 8;

/// Header of a picture. Scanlines lie along x, or along y if `columns`.
struct HdrHeader {
  glm::dvec3 factor{1};  ///< factor of the values, by exposures and colour corrections
  std::optional<Chromaticities> primaries;
  bool columns = false, from_right = false, from_bottom = false;
  int width = 0, height = 0;
};

/// Reader of lines and bytes that rejects a file that ends early.
class HdrReader {
 public:
  HdrReader(const fs::path& path, std::span<const std::uint8_t> bytes)
      : path_(path), left_(bytes) {}

  const fs::path& path() const { return path_; }
  std::size_t left() const { return left_.size(); }

  /// Returns the text up to the next end of line and advances past it.
  std::string_view line() {
    const auto end = std::ranges::find(left_, '\n');
    if (end == left_.end()) reject_image(path_, "damaged or truncated: the header has no end");
    const auto length = static_cast<std::size_t>(end - left_.begin());
    std::string_view text(reinterpret_cast<const char*>(left_.data()), length);
    left_ = left_.subspan(length + 1);
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
  }

  std::uint8_t byte() { return take(1)[0]; }

  std::span<const std::uint8_t> take(std::size_t count) {
    if (count > left_.size()) reject_image(path_, "damaged or truncated: the pixels end early");
    const auto taken = left_.first(count);
    left_ = left_.subspan(count);
    return taken;
  }

  std::span<const std::uint8_t> peek(std::size_t count) const {
    return left_.first(std::min(count, left_.size()));
  }

 private:
  const fs::path& path_;
  std::span<const std::uint8_t> left_;
};

std::vector<std::string_view> words_of(std::string_view text) {
  constexpr std::string_view kBlanks = " \t";
  std::vector<std::string_view> words;
  for (std::size_t at; (at = text.find_first_not_of(kBlanks)) != std::string_view::npos;) {
    text.remove_prefix(at);
    words.push_back(text.substr(0, text.find_first_of(kBlanks)));
    text.remove_prefix(words.back().size());
  }
  return words;
}

[[noreturn]] void reject_line(const fs::path& path, std::string_view name, std::string_view found,
                              std::string_view allowed) {
  reject(path.string(), name, fmt::format("'{}'", printable(found.substr(0, 80))), allowed);
}

/// Parses the value of a header line as `Count` numbers.
template <std::size_t Count>
std::array<double, Count> numbers_in(const fs::path& path, std::string_view name,
                                     std::string_view value) {
  const std::vector<std::string_view> words = words_of(value);
  const std::string allowed = fmt::format("{} numbers", Count);
  if (words.size() != Count) reject_line(path, name, value, allowed);
  std::array<double, Count> numbers;
  for (std::size_t i = 0; i < Count; ++i) {
    const auto number = parse_number<double>(words[i]);
    if (!number) reject_line(path, name, value, allowed);
    numbers[i] = *number;
  }
  return numbers;
}

void divide(const fs::path& path, glm::dvec3& factor, std::string_view name, std::string_view value,
            const glm::dvec3& by) {
  factor /= by;
  for (int i = 0; i < 3; ++i)
    if (!(by[i] > 0 && factor[i] > 0 && std::isfinite(factor[i])))
      reject_line(path, name, value, "above 0, and products that are finite");
}

/// Reads one line "NAME=VALUE". Others, such as commands and indented lines, say nothing of the
/// values.
void read_variable(const fs::path& path, std::string_view line, HdrHeader& header) {
  const std::size_t equal = line.find('=');
  if (equal == std::string_view::npos) return;
  const std::string_view name = line.substr(0, equal), value = line.substr(equal + 1);
  if (name == "FORMAT") {
    const auto words = words_of(value);
    if (words.size() != 1 || words[0] != kFormat) reject_line(path, name, value, kFormat);
  } else if (name == "EXPOSURE") {
    divide(path, header.factor, name, value, glm::dvec3(numbers_in<1>(path, name, value)[0]));
  } else if (name == "COLORCORR") {
    const auto by = numbers_in<3>(path, name, value);
    divide(path, header.factor, name, value, {by[0], by[1], by[2]});
  } else if (name == "GAMMA") {
    if (numbers_in<1>(path, name, value)[0] != 1)
      reject_line(path, name, value, "1: linear values");
  } else if (name == "PRIMARIES") {
    header.primaries = numbers_in<8>(path, name, value);
  }
}

/// Reads the line of resolution and orientation, such as "-Y 480 +X 640": the slow axis first.
void read_resolution(const fs::path& path, std::string_view line, HdrHeader& header) {
  const std::vector<std::string_view> words = words_of(line);
  const auto fail = [&] {
    reject_line(path, "resolution", line,
                "the axes, signs and sizes of X and Y, like -Y 480 +X 640");
  };
  if (words.size() != 4) fail();
  bool x = false, y = false;
  for (const std::size_t at : {std::size_t{0}, std::size_t{2}}) {
    const std::string_view axis = words[at];
    const auto size = parse_number<int>(words[at + 1]);
    if (!size || axis.size() != 2 || (axis[0] != '+' && axis[0] != '-')) fail();
    if (axis[1] == 'X') {
      x = true, header.width = *size, header.from_right = axis[0] == '-';
    } else if (axis[1] == 'Y') {
      y = true, header.height = *size, header.from_bottom = axis[0] == '+';
    }
  }
  if (!x || !y) fail();
  header.columns = words[0][1] == 'X';
}

HdrHeader read_header(HdrReader& file) {
  HdrHeader header;
  for (std::string_view line = file.line(); !line.empty(); line = file.line())
    read_variable(file.path(), line, header);
  read_resolution(file.path(), file.line(), header);
  return header;
}

[[noreturn]] void reject_run(const HdrReader& file) {
  reject_image(file.path(), "damaged or truncated: a run exceeds its scanline");
}

/// Reads a scanline of pixels of which some repeat the one before: mantissas 1, 1, 1 and a count,
/// whose further bytes follow likewise.
void read_pixels(HdrReader& file, std::span<std::uint8_t> line) {
  int shift = 0;
  for (std::size_t at = 0; at < line.size();) {
    const auto pixel = file.take(kPixelBytes);
    if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
      std::ranges::copy(pixel, line.begin() + static_cast<std::ptrdiff_t>(at));
      at += kPixelBytes, shift = 0;
      continue;
    }
    const std::size_t count = shift < 32 ? std::size_t{pixel[3]} << shift : 0;
    if (at == 0 || count > (line.size() - at) / kPixelBytes) reject_run(file);
    for (std::size_t i = 0; i < count * kPixelBytes; ++i, ++at) line[at] = line[at - kPixelBytes];
    shift += 8;
  }
}

/// Reads a run-length encoded scanline: each of the four bytes of a pixel by itself, a code above
/// 128 and a byte for runs, else a count and bytes.
void read_runs(HdrReader& file, std::span<std::uint8_t> line) {
  const std::size_t width = line.size() / kPixelBytes;
  for (std::size_t channel = 0; channel < kPixelBytes; ++channel) {
    for (std::size_t x = 0; x < width;) {
      const std::uint8_t code = file.byte();
      const bool run = code > 128;
      const std::size_t count = run ? code - 128u : code;
      if (count > width - x) reject_run(file);
      const auto bytes = file.take(run ? 1 : count);
      for (std::size_t i = 0; i < count; ++i, ++x)
        line[x * kPixelBytes + channel] = bytes[run ? 0 : i];
    }
  }
}

void read_scanline(HdrReader& file, std::span<std::uint8_t> line) {
  const std::size_t width = line.size() / kPixelBytes;
  const auto start = file.peek(kPixelBytes);
  const bool runs = width >= kMinRunWidth && width <= kMaxRunWidth && start.size() == kPixelBytes &&
                    start[0] == 2 && start[1] == 2 && start[2] < 128;
  if (!runs) return read_pixels(file, line);
  file.take(kPixelBytes);
  const std::size_t declared = start[2] * 256u + start[3];
  if (declared != width) {
    reject_image(
        file.path(),
        fmt::format("damaged or truncated: a scanline of {} pixels; allowed: {}", declared, width));
  }
  read_runs(file, line);
}

}  // namespace

Image decode_hdr(const fs::path& path, std::span<const std::uint8_t> bytes,
                 const ImageLimits& limits) {
  HdrReader file(path, bytes);
  const HdrHeader header = read_header(file);
  check_size(path, {.width = header.width, .height = header.height, .channels = 3}, limits);
  const int lines = header.columns ? header.width : header.height,
            along = header.columns ? header.height : header.width;
  if (file.left() < kPixelBytes * static_cast<std::size_t>(lines))
    reject_image(path, "damaged or truncated: the pixels end early");
  Image image = make_image(header.width, header.height, {"R", "G", "B"});
  Bytes line(kPixelBytes * static_cast<std::size_t>(along));
  for (int slow = 0; slow < lines; ++slow) {
    read_scanline(file, line);
    for (int fast = 0; fast < along; ++fast) {
      const int x = header.columns ? slow : fast, y = header.columns ? fast : slow;
      const std::uint8_t* pixel = &line[kPixelBytes * static_cast<std::size_t>(fast)];
      const double unit = pixel[3] ? std::ldexp(1.0, pixel[3] - kExponentBias) : 0;
      for (int c = 0; c < 3; ++c) {
        image.at(header.from_right ? header.width - 1 - x : x,
                 header.from_bottom ? header.height - 1 - y : y, static_cast<std::size_t>(c)) =
            static_cast<float>(pixel[c] * unit * header.factor[c]);
      }
    }
  }
  if (header.primaries) convert_primaries(path, image, *header.primaries);
  return image;
}

}  // namespace clpv
