// SPDX-License-Identifier: MIT
// Numbers in the bytes of files, and their checksum.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace clpv {

/// Appends the bytes of numbers in little endian.
template <typename To, typename... Numbers>
void append_little(To& to, Numbers... numbers) {
  static_assert(std::endian::native == std::endian::little);
  const auto append = [&to](const auto& number) {
    const auto* bytes = reinterpret_cast<const typename To::value_type*>(&number);
    to.insert(to.end(), bytes, bytes + sizeof number);
  };
  (append(numbers), ...);
}

/// Returns the number of `size` bytes at byte `at`. Requires at + size <= bytes.size().
template <typename Number = std::uint32_t>
Number little_endian(std::span<const std::uint8_t> bytes, std::size_t at,
                     std::size_t size = sizeof(Number)) {
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8 | bytes[at + i];
  return static_cast<Number>(value);
}
inline std::uint32_t big_endian(std::span<const std::uint8_t> bytes, std::size_t at,
                                std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | bytes[at + i];
  return value;
}

/// CRC-32 of ZIP and PNG (ISO 3309).
std::uint32_t crc32(std::span<const std::byte> bytes);

}  // namespace clpv
