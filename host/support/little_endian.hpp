// SPDX-License-Identifier: MIT
// Numbers of files that write their least byte first, whatever the host does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace clpv {

/// The four bytes from `at` on, which must be there.
inline std::uint32_t little_endian_word(std::span<const std::uint8_t> bytes, std::size_t at) {
  return bytes[at] | bytes[at + 1] << 8 | bytes[at + 2] << 16 | std::uint32_t{bytes[at + 3]} << 24;
}

}  // namespace clpv
