// SPDX-License-Identifier: MIT
#include "support/fingerprint.hpp"

#include <fmt/format.h>

#include <cstring>
#include <fstream>

#include "support/error.hpp"

namespace clpv {
namespace {

/// Finaliser of SplitMix64 (Steele, Lea, Flood 2014): every bit of x affects every bit of the
/// result.
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace

Fingerprint& Fingerprint::add(std::span<const std::byte> bytes) {
  constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15u;
  state_ = mixed(state_ + kStep + bytes.size());
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, &bytes[at], std::min(sizeof(word), bytes.size() - at));
    state_ = mixed((state_ ^ word) + kStep);
  }
  return *this;
}

std::string Fingerprint::hex() const {
  return fmt::format("{:016x}", state_);
}

std::string program_fingerprint() {
  constexpr const char* kSelf = "/proc/self/exe";
  std::ifstream file(kSelf, std::ios::binary | std::ios::ate);
  std::vector<char> bytes(file ? static_cast<std::size_t>(file.tellg()) : 0);
  file.seekg(0).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file) throw Error(ExitCode::run_time, "{}: cannot read the program's own file", kSelf);
  return Fingerprint().add(bytes).hex();
}

}  // namespace clpv
