// SPDX-License-Identifier: MIT
#include "device/program_cache.hpp"

#include <cstdlib>
#include <cstring>
#include <regex>
#include <system_error>

#include "device/driver_cache.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

// "clpv" and the version of the file format. Files that start otherwise are ignored.
constexpr std::string_view kMagic = "clpv program 2\n";
constexpr std::string_view kSuffix = ".program";

/// Hash for file names and checksums. Keys are compared in full.
std::uint64_t hash_of(std::string_view bytes) {
  return Fingerprint().add(bytes).value();
}

/// File contents: magic; key and binary, each with its length; hash of all preceding bytes.
std::string pack(const std::string& key, const ProgramCache::Binary& binary) {
  std::string bytes(kMagic);
  const auto append = [&bytes](const void* data, std::uint64_t size) {
    bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
    bytes.append(static_cast<const char*>(data), size);
  };
  append(key.data(), key.size());
  append(binary.data(), binary.size());
  const std::uint64_t hash = hash_of(bytes);
  return bytes.append(reinterpret_cast<const char*>(&hash), sizeof hash);
}

/// Removes `size` bytes from the front of `rest`; returns false if `rest` is shorter.
bool take(std::string_view& rest, std::uint64_t size, std::string_view& taken) {
  if (size > rest.size()) return false;
  taken = rest.substr(0, size);
  rest.remove_prefix(size);
  return true;
}

bool take_sized(std::string_view& rest, std::string_view& taken) {
  std::string_view bytes;
  std::uint64_t size = 0;
  if (!take(rest, sizeof size, bytes)) return false;
  std::memcpy(&size, bytes.data(), sizeof size);
  return take(rest, size, taken);
}

/// Returns the binary in a file's contents if these are intact and belong to `key`.
std::optional<ProgramCache::Binary> unpack(std::string_view bytes, const std::string& key) {
  std::uint64_t hash = 0;
  if (bytes.size() < kMagic.size() + sizeof hash || !bytes.starts_with(kMagic)) return std::nullopt;
  std::memcpy(&hash, bytes.data() + bytes.size() - sizeof hash, sizeof hash);
  bytes.remove_suffix(sizeof hash);
  if (hash_of(bytes) != hash) return std::nullopt;
  bytes.remove_prefix(kMagic.size());
  std::string_view stored_key, binary;
  if (!take_sized(bytes, stored_key) || !take_sized(bytes, binary) || stored_key != key)
    return std::nullopt;
  return ProgramCache::Binary(binary.begin(), binary.end());
}

}  // namespace

ProgramCache::ProgramCache(fs::path folder, std::uint64_t max_bytes)
    : folder_(std::move(folder)), max_bytes_(max_bytes) {}

std::optional<ProgramCache> ProgramCache::of_user(const Device& device) {
  const char* setting = std::getenv("CLPV_PROGRAM_CACHE");
  const std::string_view value = setting == nullptr ? "" : setting;
  if (value == "off") return std::nullopt;
  if (!value.empty() && value != "on")
    throw Error(ExitCode::usage, "CLPV_PROGRAM_CACHE: found '{}', allowed: on, off", value);
  if (value.empty() && driver_keeps_kernels(device)) return std::nullopt;
  if (const auto folder = user_cache_folder()) return ProgramCache(*folder);
  log_debug(
      "neither XDG_CACHE_HOME nor HOME is an absolute path: compiled programs are not cached");
  return std::nullopt;
}

std::string ProgramCache::key(const Device& device, const std::string& options,
                              const std::string& text) {
  return fmt::format("{}\n{}\n{}\n{}\n{}\n{}{}\n{}", device.platform, device.platform_version,
                     device.name, device.version, device.driver,
                     driver_settings(DriverSettings::compilation), options, text);
}

fs::path ProgramCache::file_of(const std::string& key) const {
  return folder() / fmt::format("{:016x}{}", hash_of(key), kSuffix);
}

std::optional<ProgramCache::Binary> ProgramCache::load(const std::string& key) const {
  const fs::path file = file_of(key);
  const auto bytes = folder_.read(file.filename().string());
  if (!bytes) return std::nullopt;
  std::optional<Binary> binary = unpack(*bytes, key);
  if (!binary) {
    log_debug("{}: damaged or of another program; compiling it again", file.string());
    return std::nullopt;
  }
  std::error_code ignored;  // the time of last use only orders eviction
  fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
  return binary;
}

bool ProgramCache::store(const std::string& key, const Binary& binary) const {
  const std::string why = folder_.write(file_of(key).filename().string(), pack(key, binary));
  if (!why.empty()) {
    log_warning("compiled programs are not cached: {}", why);
    return false;
  }
  // Names of file_of(), and of the OutputFiles of killed processes.
  static const std::regex kOwn(R"([0-9a-f]{16}\.program|\.[0-9a-f]{16}\.program\.\d+-\d+\.part)");
  folder_.evict(kOwn, max_bytes_);
  return true;
}

void ProgramCache::remove(const std::string& key) const {
  // Missing or not removable: the next store() replaces it or reports why not.
  std::error_code ignored;
  fs::remove(file_of(key), ignored);
}

}  // namespace clpv
