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
#include "support/process.hpp"
#include "support/this_program.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVendors = "/etc/OpenCL/vendors";
constexpr std::uintmax_t kMostBytes = 4096;   // of an .icd file: one path
constexpr std::chrono::seconds kLoading{20};  // longer than any driver takes
constexpr int kSignalled = 128;               // exit code after a signal, less the signal

std::string library_of(const fs::path& icd_file) {
  const std::string text = file_bytes(icd_file, kMostBytes).value_or("");
  const std::string line = text.substr(0, text.find_first_of("\r\n"));
  return line.substr(0, line.find_last_not_of(" \t") + 1);
}

/// Class, byte order and machine in the header of an ELF file; empty for other files.
std::string machine_of(const fs::path& file) {
  char header[20] = {};
  std::ifstream(file, std::ios::binary).read(header, sizeof header);
  if (std::memcmp(header, "\x7f" "ELF", 4) != 0) return {};
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

FaultyDriver loaded_in_child(const fs::path& icd_file) {
  Process child(this_program(), {"devices", "--load-driver", icd_file.string(), "--quiet"});
  const auto end = std::chrono::steady_clock::now() + kLoading;
  while (child.running() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const bool late = child.running();
  if (late) child.kill();
  Process::Result result = child.end();
  while (result.output.ends_with('\n')) result.output.pop_back();
  if (late)
    return {icd_file.string(), fmt::format("does not load within {} s", kLoading.count()), true};
  if (result.code > kSignalled)
    return {icd_file.string(),
            fmt::format("{}: ends the process by signal {} ({}) when loaded{}{}",
                        library_of(icd_file), result.code - kSignalled,
                        ::strsignal(result.code - kSignalled),
                        result.output.empty() ? "" : ": ", result.output),
            true};
  return {icd_file.string(), result.code == 0 ? "" : result.output};
}

}  // namespace

std::vector<fs::path> driver_files() {
  const char* set = std::getenv("OCL_ICD_VENDORS");
  const fs::path where = set != nullptr && *set != '\0' ? set : kVendors;
  if (where.extension() == ".icd") return {where};
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(where, ignored))
    if (entry.path().extension() == ".icd") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::vector<FaultyDriver> faulty_drivers() {
  std::vector<FaultyDriver> faulty;
  for (const fs::path& file : driver_files()) {
    FaultyDriver driver{file.string(), fault_of_file(library_of(file))};
    if (driver.reason.empty() && !this_program().empty()) driver = loaded_in_child(file);
    if (!driver.reason.empty()) faulty.push_back(std::move(driver));
  }
  return faulty;
}

void load_driver(const fs::path& icd_file) {
  if (::dlopen(library_of(icd_file).c_str(), RTLD_NOW | RTLD_LOCAL) == nullptr)
    throw Error(ExitCode::device, "{}", ::dlerror());
  ::setenv("OCL_ICD_VENDORS", icd_file.c_str(), 1);
  list_devices();
}

void leave_out(const std::vector<FaultyDriver>& faulty, const fs::path& folder) {
  for (const fs::path& file : driver_files())
    if (std::ranges::count(faulty, file.string(), &FaultyDriver::file) == 0)
      fs::create_symlink(fs::absolute(file), folder / file.filename());
  ::setenv("OCL_ICD_VENDORS", folder.c_str(), 1);
}

}  // namespace clpv
