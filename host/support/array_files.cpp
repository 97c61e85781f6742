// SPDX-License-Identifier: MIT
#include "support/array_files.hpp"

#include <fmt/ranges.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "support/output_file.hpp"

namespace clpv {

std::uint32_t crc32(std::span<const std::byte> bytes) {
  static const std::array<std::uint32_t, 256> kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      table[i] = i;
      for (int bit = 0; bit < 8; ++bit)
        table[i] = table[i] & 1 ? table[i] >> 1 ^ 0xedb88320u : table[i] >> 1;
    }
    return table;
  }();
  std::uint32_t crc = ~0u;
  for (const std::byte b : bytes)
    crc = crc >> 8 ^ kTable[(crc ^ std::to_integer<std::uint32_t>(b)) & 0xff];
  return ~crc;
}

namespace {

constexpr std::string_view kMagic("\x93NUMPY\x01\x00", 8);
constexpr std::size_t kPreamble = kMagic.size() + 2;  // magic, then the header's length in 16 bits
constexpr std::size_t kAlignment = 64;  // alignment of the data, required by the format

/// Magic, version, and the header's dictionary, padded; the data follow.
std::string preamble(const std::string& type, const std::string& shape) {
  std::string header =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
  const std::size_t used = kPreamble + header.size() + 1;
  header.append((kAlignment - used % kAlignment) % kAlignment, ' ').push_back('\n');
  std::string file(kMagic);
  file.push_back(static_cast<char>(header.size() & 0xff));
  file.push_back(static_cast<char>(header.size() >> 8));
  return file + header;
}

}  // namespace

std::string npy_bytes(std::span<const float> values, std::span<const std::size_t> shape) {
  std::size_t count = 1;
  for (const std::size_t extent : shape) count *= extent;
  if (count != values.size())
    throw std::logic_error("npy_bytes: shape and number of values differ");
  // A Python tuple of one element needs a comma.
  std::string file =
      preamble("<f4", fmt::format("{}{}", fmt::join(shape, ", "), shape.size() == 1 ? "," : ""));
  return file.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

std::string npy_bytes(const std::string& text) {
  std::string file = preamble(fmt::format("<U{}", text.size()), "");
  for (const char c : text) append_little(file, static_cast<std::uint32_t>(c));
  return file;
}

std::string npz_bytes(const std::vector<std::pair<std::string, std::string>>& arrays) {
  constexpr std::uint16_t kVersion = 20, kNone = 0, kFirstDay = 33;  // 1 January 1980
  std::string file, directory;
  for (const auto& [array, bytes] : arrays) {
    const std::string name = array + ".npy";
    const auto size = static_cast<std::uint32_t>(bytes.size()),
               start = static_cast<std::uint32_t>(file.size());
    std::string common;  // common text of both headers
    append_little(common, kVersion, kNone, kNone, kNone, kFirstDay,
                  crc32(std::as_bytes(std::span(bytes))), size, size,
                  static_cast<std::uint16_t>(name.size()), kNone);
    file += "PK\x03\x04" + common + name + bytes;
    directory += "PK\x01\x02";
    append_little(directory, kVersion);
    directory += common;
    append_little(directory, kNone, kNone, kNone, std::uint32_t{0}, start);
    directory += name;
  }
  const auto start = static_cast<std::uint32_t>(file.size()),
             size = static_cast<std::uint32_t>(directory.size());
  const auto count = static_cast<std::uint16_t>(arrays.size());
  file += directory + "PK\x05\x06";
  append_little(file, kNone, kNone, count, count, size, start, kNone);
  return file;
}

void write_npy(const std::filesystem::path& path, std::span<const float> values,
               std::span<const std::size_t> shape) {
  write_file(path, npy_bytes(values, shape), OutputFile::Kind::entry);
}

}  // namespace clpv
