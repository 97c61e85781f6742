// SPDX-License-Identifier: MIT
// Writes arrays as NumPy .npy, and several as .npz.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace clpv {

/// Writes a .npy file of version 1.0, little endian, in C order (last index fastest). The product
/// of `shape` equals values.size(). Throws Error(run_time) if the file cannot be written.
void write_npy(const std::filesystem::path& path, std::span<const float> values,
               std::span<const std::size_t> shape);

/// Bytes of a .npy file: float32, or a text without a shape, of ASCII characters.
std::string npy_bytes(std::span<const float> values, std::span<const std::size_t> shape);
std::string npy_bytes(const std::string& text);

/// Bytes of a .npz file, a ZIP archive without compression, of .npy files by array name. All
/// together at most 2 GiB.
std::string npz_bytes(const std::vector<std::pair<std::string, std::string>>& arrays);

// Numbers in the bytes of files, and their checksum.

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
