// SPDX-License-Identifier: MIT
// Reader of an encoded image in memory for OpenImageIO, with checked offsets.
#pragma once

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace clpv {

/// Rejects offsets outside the bytes. OpenImageIO 2.4's reader copies from before the bytes for negative offsets, which the
/// chunk tables of an EXR may contain.
class MemoryReader : public OIIO::Filesystem::IOMemReader {
 public:
  /// Borrows the bytes.
  explicit MemoryReader(std::span<const std::uint8_t> bytes) : IOMemReader(bytes.data(), bytes.size()) {}

  bool seek(std::int64_t offset) override { return holds(offset) && IOMemReader::seek(offset); }

  std::size_t pread(void* to, std::size_t count, std::int64_t offset) override {
    if (!holds(offset)) return 0;
    return IOMemReader::pread(to, std::min(count, size() - static_cast<std::size_t>(offset)), offset);
  }

 private:
  bool holds(std::int64_t offset) const { return offset >= 0 && static_cast<std::size_t>(offset) <= size(); }
};

}  // namespace clpv
