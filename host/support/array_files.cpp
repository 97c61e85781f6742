// SPDX-License-Identifier: MIT
#include "support/array_files.hpp"

#include <fmt/ranges.h>

#include <bit>
#include <stdexcept>
#include <string>

#include "support/output_file.hpp"

namespace clpv {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written in memory order");

constexpr std::string_view kMagic("\x93NUMPY\x01\x00", 8);
constexpr std::size_t kPreamble = kMagic.size() + 2;  // magic, then the header's length in 16 bits
constexpr std::size_t kAlignment = 64;                // of the data, required by the format

}  // namespace

void write_npy(const std::filesystem::path& path, std::span<const float> values,
               std::span<const std::size_t> shape) {
  std::size_t count = 1;
  for (const std::size_t extent : shape) count *= extent;
  if (count != values.size())
    throw std::logic_error("write_npy: shape and number of values differ");
  // A Python tuple of one element needs a comma.
  std::string header = fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}{}), }}",
                                   fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
  const std::size_t used = kPreamble + header.size() + 1;
  header.append((kAlignment - used % kAlignment) % kAlignment, ' ').push_back('\n');
  std::string file(kMagic);
  file.push_back(static_cast<char>(header.size() & 0xff));
  file.push_back(static_cast<char>(header.size() >> 8));
  file += header;
  file.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  write_file(path, file, OutputFile::Kind::entry);
}

}  // namespace clpv
