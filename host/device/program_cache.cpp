// SPDX-License-Identifier: MIT
#include "device/program_cache.hpp"

#include <cstdlib>
#include <regex>
#include <system_error>

#include "device/driver_cache.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSuffix = ".program";

/// Start of a file's contents: the whole key, since two keys may share the hash in the file's name.
std::string head_of(const std::string& key) {
  return key + '\0';
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
  return folder() / fmt::format("{}{}", Fingerprint().add(key).hex(), kSuffix);
}

std::optional<ProgramCache::Binary> ProgramCache::load(const std::string& key) const {
  const fs::path file = file_of(key);
  const auto bytes = folder_.read_checked(file.filename().string());
  const std::string head = head_of(key);
  if (!bytes || !bytes->starts_with(head)) return std::nullopt;
  std::error_code ignored;  // the time of last use only orders eviction
  fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
  return Binary(bytes->begin() + static_cast<std::ptrdiff_t>(head.size()), bytes->end());
}

bool ProgramCache::store(const std::string& key, const Binary& binary) const {
  const std::string why = folder_.write_checked(
      file_of(key).filename().string(), head_of(key) + std::string(binary.begin(), binary.end()));
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
