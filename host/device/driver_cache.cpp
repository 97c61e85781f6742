// SPDX-License-Identifier: MIT
#include "device/driver_cache.hpp"

#include <cstdlib>
#include <system_error>

#include "support/fingerprint.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kFullBytes = 1 << 20;  // less cannot hold a kernel and its temporary files

std::optional<fs::path> folder_of(const char* variable, const char* below) {
  const char* set = std::getenv(variable);
  if (set == nullptr || *set == '\0') return std::nullopt;
  return fs::path(set) / below;
}

std::string name_of_mark(const std::string& key) {
  return Fingerprint().add(key).hex();
}

}  // namespace

bool driver_keeps_kernels(const Device& device) {
  return device.platform == "Portable Computing Language";
}

std::optional<fs::path> driver_cache_folder() {
  if (const auto given = folder_of("POCL_CACHE_DIR", "")) return given;
  if (const auto cache = folder_of("XDG_CACHE_HOME", "pocl/kcache")) return cache;
  return folder_of("HOME", ".cache/pocl/kcache");
}

bool driver_cache_is_full() {
  const auto folder = driver_cache_folder();
  if (!folder) return false;
  std::error_code failed;
  const fs::space_info space = fs::space(*folder, failed);
  return !failed && space.available < kFullBytes;
}

CompiledMarks::CompiledMarks(const Device& device) {
  if (!driver_keeps_kernels(device)) return;
  if (const auto cache = driver_cache_folder()) folder_.emplace(*cache / "clpv");
}

bool CompiledMarks::has(const std::string& key) const {
  return folder_ && folder_->read(name_of_mark(key)).has_value();
}

void CompiledMarks::add(const std::string& key) const {
  if (!folder_) return;
  const std::string why = folder_->write(name_of_mark(key), std::string_view(""));
  if (!why.empty())
    spdlog::debug("no mark of compiled kernels: {}", why);  // costs later runs their helpers' start
}

}  // namespace clpv
