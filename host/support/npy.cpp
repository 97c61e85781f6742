// SPDX-License-Identifier: MIT
#include "support/npy.hpp"

#include <bit>
#include <cstring>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include "support/error.hpp"
#include "support/output_file.hpp"

namespace clpv {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

constexpr std::string_view kMagic("\x93NUMPY\x01\x00", 8);
constexpr std::size_t kPreamble = kMagic.size() + 2;  // then the header's length, 16 bits
constexpr std::size_t kAlignment = 64;                // of the data, asked by the format

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw Error(ExitCode::bad_input, "{}: {}", path.string(), why);
}

/// The product; refuses one that does not fit what `bytes` can hold.
std::size_t element_count(const std::filesystem::path& path, std::span<const std::size_t> shape,
                          std::size_t bytes) {
  std::size_t count = 1;
  for (const std::size_t extent : shape) {
    if (extent != 0 && count > bytes / sizeof(float) / extent)
      refuse(path, "the shape asks for more than the file holds");
    count *= extent;
  }
  return count;
}

std::vector<std::size_t> parse_shape(const std::filesystem::path& path, const std::string& header) {
  static const std::regex pattern(
      R"(\{'descr': '<f4', 'fortran_order': False, 'shape': \(((?:\d{1,9}, ?)*(?:\d{1,9})?)\), \}\s*)");
  std::smatch match;
  if (!std::regex_match(header, match, pattern)) {
    refuse(path, fmt::format("header {}; allowed is float32 ('<f4') in C order", header.substr(0, 80)));
  }
  std::vector<std::size_t> shape;
  const std::string list = match[1];
  static const std::regex number(R"(\d+)");
  for (std::sregex_iterator it(list.begin(), list.end(), number), end; it != end; ++it) {
    shape.push_back(std::stoull(it->str()));
  }
  return shape;
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
  std::ifstream stream(path, std::ios::binary);
  if (!stream) refuse(path, "cannot be opened");
  const std::string file{std::istreambuf_iterator<char>(stream), {}};
  // The last byte of the magic is the minor version.
  if (file.size() < kPreamble || file.compare(0, kMagic.size() - 1, kMagic, 0, kMagic.size() - 1) != 0) {
    refuse(path, "not a .npy file of version 1");
  }
  const std::size_t length = static_cast<unsigned char>(file[8]) + 256u * static_cast<unsigned char>(file[9]);
  if (file.size() < kPreamble + length) refuse(path, "truncated header");
  NpyArray array;
  array.shape = parse_shape(path, file.substr(kPreamble, length));
  const std::size_t bytes = file.size() - kPreamble - length;
  const std::size_t count = element_count(path, array.shape, bytes);
  if (bytes != count * sizeof(float)) {
    refuse(path, fmt::format("{} bytes of data; the shape asks for {}", bytes, count * sizeof(float)));
  }
  array.values.resize(count);
  std::memcpy(array.values.data(), file.data() + kPreamble + length, bytes);
  return array;
}

}  // namespace clpv
