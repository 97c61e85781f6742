// SPDX-License-Identifier: MIT
#include "device/driver_files.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <thread>

#include "device/device.hpp"
#include "support/error.hpp"
#include "support/input_file.hpp"
#include "support/print.hpp"
#include "support/process.hpp"
#include "support/this_program.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVendors = "/etc/OpenCL/vendors";
constexpr std::uintmax_t kMostBytes = 4096;         // an .icd file holds one path
constexpr std::chrono::seconds kLoading{20};        // longer than any driver takes
constexpr int kSignalled = 128;                     // exit code after a signal, less the signal
constexpr const char* kLoaded = "driver loaded\n";  // since a driver may end the child with code 0

std::string library_of(const fs::path& icd_file) {
  if (icd_file.extension() != ".icd") return icd_file;
  const std::string text = file_bytes(icd_file, kMostBytes).value_or("");
  const std::string line = text.substr(0, text.find_first_of("\r\n"));
  return line.substr(0, line.find_last_not_of(" \t") + 1);
}

/// Class, byte order and machine in the header of an ELF file; empty for other files.
std::string machine_of(const fs::path& file) {
  char header[20] = {};
  std::ifstream(file, std::ios::binary).read(header, sizeof header);
  if (std::memcmp(header,
                  "\x7f"
                  "ELF",
                  4) != 0)
    return {};
  return std::string(header + 4, 2) + std::string(header + 18, 2);
}

/// Returns why the file cannot be a driver of this process; empty if it may be one.
std::string fault_of_file(const std::string& library) {
  if (library.empty()) return "names no library";
  if (library.find('/') == std::string::npos) return {};  // the linker searches for it
  std::error_code ignored;
  if (!fs::exists(library, ignored)) return fmt::format("{}: no such file", library);
  if (!fs::is_regular_file(library, ignored))  // reading a pipe would wait for its writer
    return fmt::format("{}: no regular file", library);
  const std::string machine = machine_of(library);
  if (machine.empty()) return fmt::format("{}: no ELF file", library);
  if (machine != machine_of("/proc/self/exe"))
    return fmt::format("{}: of another machine; allowed: that of clpv", library);
  return {};
}

/// Returns why the driver cannot be loaded by a child process; empty if it can.
std::string fault_when_loaded(const fs::path& icd_file) {
  Process child(this_program(), {"devices", "--load-driver", icd_file.string(), "--quiet"});
  const auto end = std::chrono::steady_clock::now() + kLoading;
  while (child.running() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const bool late = child.running();
  if (late) child.kill();
  Process::Result result = child.end();
  if (late) return fmt::format("does not load within {} s", kLoading.count());
  if (result.code == 0 && result.output.find(kLoaded) != std::string::npos) return {};
  const bool ours = result.code == static_cast<int>(ExitCode::usage) ||
                    result.code == static_cast<int>(ExitCode::run_time);
  if (ours && result.output.starts_with("clpv: ")) return {};  // this process will say it, too
  while (result.output.ends_with('\n')) result.output.pop_back();
  const bool explained = result.code < 0 || result.code == static_cast<int>(ExitCode::device);
  if (explained && !result.output.empty()) return result.output;
  const int signal = result.code - kSignalled;
  const std::string by = signal > 0 ? fmt::format("by signal {} ({})", signal, ::strsignal(signal))
                                    : fmt::format("with exit code {}", result.code);
  return fmt::format("{}: ends the process {} when loaded{}{}", library_of(icd_file), by,
                     result.output.empty() ? "" : ": ", result.output);
}

}  // namespace

std::vector<fs::path> driver_files() {
  const char* set = std::getenv("OCL_ICD_VENDORS");
  const fs::path where = set != nullptr && *set != '\0' ? set : kVendors;
  std::error_code ignored;
  if (where.extension() == ".icd" || fs::is_regular_file(where, ignored)) return {where};
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(where, ignored))
    if (entry.path().extension() == ".icd") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::vector<FaultyDriver> faulty_drivers() {
  std::vector<FaultyDriver> faulty;
  for (const fs::path& file : driver_files()) {
    std::string reason = fault_of_file(library_of(file));
    if (reason.empty() && !this_program().empty()) reason = fault_when_loaded(file);
    if (!reason.empty()) faulty.push_back({file.string(), reason});
  }
  return faulty;
}

void load_driver(const fs::path& icd_file) {
  // As the loader does: of symbols that nobody calls, none need exist.
  if (::dlopen(library_of(icd_file).c_str(), RTLD_LAZY | RTLD_LOCAL) == nullptr)
    throw Error(ExitCode::device, "{}", ::dlerror());
  ::setenv("OCL_ICD_VENDORS", icd_file.c_str(), 1);
  const DeviceList list = list_devices();
  if (list.devices.empty() && list.platforms_without_devices.empty())
    throw Error(ExitCode::device, "{}: offers no OpenCL platform", library_of(icd_file));
  print_data("{}", kLoaded);
}

void leave_out(const std::vector<FaultyDriver>& faulty, const fs::path& folder) {
  for (const fs::path& file : driver_files())
    if (std::ranges::count(faulty, file.string(), &FaultyDriver::file) == 0)
      fs::create_symlink(fs::absolute(file), folder / file.filename());
  ::setenv("OCL_ICD_VENDORS", folder.c_str(), 1);
}

}  // namespace clpv
