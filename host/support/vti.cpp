// SPDX-License-Identifier: MIT
#include "support/vti.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <stdexcept>

#include "support/output_file.hpp"
#include "support/xml.hpp"

namespace clpv {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

}  // namespace

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
      throw std::logic_error("write_vti: an array does not fit the grid");
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
