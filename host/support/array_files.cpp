// SPDX-License-Identifier: MIT
#include "support/array_files.hpp"

#include <fmt/ranges.h>

#include <bit>
#include <cstdint>
#include <stdexcept>

#include "support/output_file.hpp"
#include "support/text.hpp"

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
  if (count != values.size()) throw std::logic_error("write_npy: shape and number of values differ");
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
  write_file(path, file);
}

void write_vti(const std::filesystem::path& path, const VtiGrid& grid, std::span<const VtiArray> arrays) {
  const auto& n = grid.cells;
  const std::size_t cells = std::size_t(n[0]) * std::size_t(n[1]) * std::size_t(n[2]);
  const std::string extent =
      fmt::format("0 {} 0 {} 0 {}", n[0], n[1], n[2]);  // of points: one more than cells
  std::string file = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "<ImageData WholeExtent=\"{0}\" Origin=\"{1}\" Spacing=\"{2}\">\n<Piece Extent=\"{0}\">\n<CellData>\n",
      extent, fmt::join(grid.origin, " "), fmt::join(grid.spacing, " "));
  std::string data;
  for (const VtiArray& array : arrays) {
    if (array.values.size() != cells * std::size_t(array.components)) {
      throw std::logic_error("write_vti: array size and grid differ");
    }
    file += fmt::format(
        "<DataArray type=\"Float32\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
        "offset=\"{}\"/>\n",
        xml_escaped(array.name), array.components, data.size());
    const std::uint64_t bytes = array.values.size_bytes();
    data.append(reinterpret_cast<const char*>(&bytes), sizeof bytes);
    data.append(reinterpret_cast<const char*>(array.values.data()), bytes);
  }
  file += "</CellData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_";
  file += data;
  file += "\n</AppendedData>\n</VTKFile>\n";
  write_file(path, file);
}

}  // namespace clpv
