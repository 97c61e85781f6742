// SPDX-License-Identifier: MIT
#include "bench/context.hpp"

#include <benchmark/benchmark.h>
#include <fmt/chrono.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/git_describe.h"
#include "clpv/version.hpp"
#include "device/kernel_files.hpp"
#include "support/fingerprint.hpp"

namespace clpv::bench {
namespace {

/// As the system names it; "unknown" where it does not.
std::string host_cpu() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("model name")) continue;
    const auto at = line.find(": ");
    if (at != std::string::npos) return line.substr(at + 2);
  }
  return "unknown";
}

/// Of the kernels' text in use, files of CLPV_KERNEL_DIR before embedded ones.
std::string kernel_hash() {
  Fingerprint fingerprint;
  for (const auto& [name, text] : detail::embedded_kernel_files())
    fingerprint.add(name).add(kernel_file(name));
  return fingerprint.hex();
}

std::string now() {
  return fmt::format("{:%FT%TZ}",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

nlohmann::json library_context() {
  const benchmark::CPUInfo& cpu = benchmark::CPUInfo::Get();
  nlohmann::json caches = nlohmann::json::array();
  for (const auto& cache : cpu.caches) {
    caches.push_back({{"type", cache.type},
                      {"level", cache.level},
                      {"size", cache.size},
                      {"num_sharing", cache.num_sharing}});
  }
  return {{"date", now()},
          {"host_name", benchmark::SystemInfo::Get().name},
          {"executable", "clpv"},
          {"num_cpus", cpu.num_cpus},
          {"mhz_per_cpu", static_cast<int>(cpu.cycles_per_second * 1e-6)},
          {"cpu_scaling_enabled", cpu.scaling == benchmark::CPUInfo::ENABLED},
          {"caches", caches},
          {"load_avg", cpu.load_avg},
          {"library_build_type", "release"}};
}

}  // namespace

nlohmann::json context_json(const Session& session) {
  const Device& device = session.device();
  nlohmann::json json = library_context();
  json.update({{"schema", 1},
               {"clpv_version", version()},
               {"git_describe", CLPV_GIT_DESCRIBE},
               {"host_cpu", host_cpu()},
               {"platform", device.platform},
               {"platform_version", device.platform_version},
               {"device", device.name},
               {"driver", device.driver},
               {"compute_units", device.compute_units},
               {"build_options", ProgramSource{}.options},
               {"kernel_hash", kernel_hash()}});
  return json;
}

}  // namespace clpv::bench
