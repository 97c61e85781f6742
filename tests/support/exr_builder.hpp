// SPDX-License-Identifier: MIT
// EXR files of uncompressed scanlines, byte by byte: windows, parts and types that clpv does not
// write.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/gltf_builder.hpp"

namespace clpv::test {

struct ExrBox {
  int left, top, right, bottom;  ///< both corners are included
};

struct ExrPart {
  std::vector<std::string> channels;  ///< in alphabetical order
  ExrBox data, display;
  /// By channel and coordinates.
  std::function<float(const std::string& channel, int x, int y)> value;
  std::string name = {};                ///< name of one of several parts
  std::vector<std::string> integers{};  ///< channels of type UINT; the others are FLOAT
  std::vector<float> chromaticities{};  ///< attribute, unless empty
  std::string attributes = {};          ///< more of them
  std::uint32_t sampling = 1;
};

inline std::string exr_attribute(const std::string& name, const std::string& type,
                                 const std::string& value) {
  return name + '\0' + type + '\0' +
         bytes_of<std::uint32_t>({static_cast<std::uint32_t>(value.size())}) + value;
}

inline std::string exr_box(const std::string& name, const ExrBox& box) {
  return exr_attribute(name, "box2i",
                       bytes_of<std::int32_t>({box.left, box.top, box.right, box.bottom}));
}

inline bool is_integer(const ExrPart& part, const std::string& channel) {
  return std::ranges::count(part.integers, channel) > 0;
}

inline std::string exr_header(const ExrPart& part, bool several) {
  std::string channels;
  for (const std::string& name : part.channels)
    channels += name + '\0' +
                bytes_of<std::uint32_t>(
                    {is_integer(part, name) ? 0u : 2u, 0, part.sampling, part.sampling});
  const int rows = part.data.bottom - part.data.top + 1;
  std::string header = exr_attribute("channels", "chlist", channels + '\0') +
                       exr_attribute("compression", "compression", std::string(1, '\0')) +
                       exr_box("dataWindow", part.data) + exr_box("displayWindow", part.display) +
                       exr_attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
                       exr_attribute("pixelAspectRatio", "float", bytes_of<float>({1})) +
                       exr_attribute("screenWindowCenter", "v2f", bytes_of<float>({0, 0})) +
                       exr_attribute("screenWindowWidth", "float", bytes_of<float>({1})) +
                       part.attributes;
  if (!part.chromaticities.empty()) {
    std::string numbers;
    for (const float number : part.chromaticities) numbers += bytes_of<float>({number});
    header += exr_attribute("chromaticities", "chromaticities", numbers);
  }
  if (several) {
    header += exr_attribute("name", "string", part.name) +
              exr_attribute("type", "string", "scanlineimage") +
              exr_attribute("chunkCount", "int", bytes_of<std::int32_t>({rows}));
  }
  return header + '\0';
}

/// The pixels of one row, channel by channel.
inline std::string exr_row(const ExrPart& part, int y) {
  std::string row;
  for (const std::string& name : part.channels) {
    for (int x = part.data.left; x <= part.data.right; ++x) {
      const float value = part.value(name, x, y);
      row +=
          bytes_of<std::uint32_t>({is_integer(part, name) ? static_cast<std::uint32_t>(value)
                                                          : std::bit_cast<std::uint32_t>(value)});
    }
  }
  return row;
}

/// A file of one part or several.
inline std::string exr_file(const std::vector<ExrPart>& parts) {
  const bool several = parts.size() > 1;
  std::string file = "\x76\x2f\x31\x01" + bytes_of<std::uint32_t>({several ? 0x1002u : 2u});
  std::size_t rows = 0;
  for (const ExrPart& part : parts) {
    file += exr_header(part, several);
    rows += static_cast<std::size_t>(part.data.bottom - part.data.top + 1);
  }
  if (several) file += '\0';
  std::string table, chunks;
  const std::size_t first = file.size() + 8 * rows;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (int y = parts[i].data.top; y <= parts[i].data.bottom; ++y) {
      table += bytes_of<std::uint64_t>({first + chunks.size()});
      const std::string row = exr_row(parts[i], y);
      if (several) chunks += bytes_of<std::uint32_t>({static_cast<std::uint32_t>(i)});
      chunks += bytes_of<std::int32_t>({y, static_cast<std::int32_t>(row.size())}) + row;
    }
  }
  return file + table + chunks;
}

}  // namespace clpv::test
