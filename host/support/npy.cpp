// SPDX-License-Identifier: MIT
#include "support/npy.hpp"

#include <bit>
#include <charconv>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "support/error.hpp"
#include "support/input_file.hpp"
#include "support/output_file.hpp"

namespace clpv {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

constexpr std::string_view kMagic("\x93NUMPY\x01\x00", 8);
constexpr std::size_t kPreamble = kMagic.size() + 2;  // then the header's length, 16 bits
constexpr std::uintmax_t kMostArrayBytes = std::uintmax_t{1} << 32;
constexpr std::size_t kAlignment = 64;  // of the data, asked by the format

[[noreturn]] void refuse_npy(const std::filesystem::path& path, const std::string& why) {
  throw Error(ExitCode::bad_input, "{}: {}", path.string(), why);
}

/// The product; refuses one that does not fit what `bytes` can hold.
std::size_t element_count(const std::filesystem::path& path, std::span<const std::size_t> shape,
                          std::size_t bytes) {
  std::size_t count = 1;
  for (const std::size_t extent : shape) {
    if (extent != 0 && count > bytes / sizeof(float) / extent)
      refuse_npy(path, "the shape asks for more than the file holds");
    count *= extent;
  }
  return count;
}

/// "3, 1, 2" or "4," or nothing, as Python writes the inside of a tuple; nothing where it is none. By hand: the standard
/// library's regular expressions recurse once a character, and a header may have 65535.
std::optional<std::vector<std::size_t>> parse_tuple(std::string_view list) {
  constexpr std::size_t kLargest = 999999999;
  std::vector<std::size_t> shape;
  while (!list.empty()) {
    std::size_t extent = 0;
    const auto [end, error] = std::from_chars(list.data(), list.data() + list.size(), extent);
    if (error != std::errc{} || extent > kLargest) return std::nullopt;
    shape.push_back(extent);
    list.remove_prefix(static_cast<std::size_t>(end - list.data()));
    if (list.empty()) break;
    if (list.front() != ',') return std::nullopt;
    list.remove_prefix(1);
    if (!list.empty() && list.front() == ' ') list.remove_prefix(1);
  }
  return shape;
}

std::vector<std::size_t> parse_shape(const std::filesystem::path& path, const std::string& header) {
  constexpr std::string_view kBefore = "{'descr': '<f4', 'fortran_order': False, 'shape': (", kAfter = "), }";
  std::string_view text(header);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\n')) text.remove_suffix(1);
  if (text.size() >= kBefore.size() + kAfter.size() && text.starts_with(kBefore) && text.ends_with(kAfter)) {
    text.remove_prefix(kBefore.size());
    text.remove_suffix(kAfter.size());
    if (auto shape = parse_tuple(text)) return *shape;
  }
  refuse_npy(path, fmt::format("header {}; allowed is float32 ('<f4') in C order", header.substr(0, 80)));
}

}  // namespace

void write_npy(const std::filesystem::path& path, std::span<const float> values,
               std::span<const std::size_t> shape) {
  std::size_t count = 1;
  for (const std::size_t extent : shape) count *= extent;
  if (count != values.size()) throw std::logic_error("write_npy: the shape does not fit the values");
  // A tuple of one needs its comma.
  std::string header = fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}{}), }}",
                                   fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
  const std::size_t used = kPreamble + header.size() + 1;
  header.append((kAlignment - used % kAlignment) % kAlignment, ' ').push_back('\n');
  std::string file(kMagic);
  file.push_back(static_cast<char>(header.size() & 0xff));
  file.push_back(static_cast<char>(header.size() >> 8));
  file += header;
  file.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  write_file(path, file);
}

NpyArray read_npy(const std::filesystem::path& path) {
  const auto bytes_read = file_bytes(path, kMostArrayBytes);
  if (!bytes_read) refuse_npy(path, "cannot be read");
  const std::string& file = *bytes_read;
  // The last byte of the magic is the minor version.
  if (file.size() < kPreamble || file.compare(0, kMagic.size() - 1, kMagic, 0, kMagic.size() - 1) != 0) {
    refuse_npy(path, "not a .npy file of version 1");
  }
  const std::size_t length = static_cast<unsigned char>(file[8]) + 256u * static_cast<unsigned char>(file[9]);
  if (file.size() < kPreamble + length) refuse_npy(path, "truncated header");
  NpyArray array;
  array.shape = parse_shape(path, file.substr(kPreamble, length));
  const std::size_t bytes = file.size() - kPreamble - length;
  const std::size_t count = element_count(path, array.shape, bytes);
  if (bytes != count * sizeof(float)) {
    refuse_npy(path, fmt::format("{} bytes of data; the shape asks for {}", bytes, count * sizeof(float)));
  }
  array.values.resize(count);
  if (bytes > 0) std::memcpy(array.values.data(), file.data() + kPreamble + length, bytes);
  return array;
}

}  // namespace clpv
