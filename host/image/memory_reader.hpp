// SPDX-License-Identifier: MIT
// An encoded image in memory, as OpenImageIO reads it.
#pragma once

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace clpv {

/// OpenImageIO's own goes wherever a file sends it (2.4 copies from before the bytes for a negative place, which the chunk
/// tables of an EXR may hold): here only places within the bytes are gone to, and only what is there is read.
class MemoryReader : public OIIO::Filesystem::IOMemReader {
 public:
  /// The bytes must outlive it.
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
