// SPDX-License-Identifier: MIT
// clpv devices: lists all OpenCL devices and their capabilities.

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "device/device.hpp"
#include "support/cache_folder.hpp"
#include "support/error.hpp"
#include "support/helpers.hpp"
#include "support/input_file.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/process.hpp"

namespace clpv {

namespace {

namespace fs = std::filesystem;

// The .icd files that name OpenCL drivers, and those among them that cannot be loaded.

/// A driver that the loader leaves out silently, or that ends or stops the process.
struct FaultyDriver {
  std::string file, reason;
};

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

/// Returns why the driver cannot be loaded by a child process; empty if it can.
std::string fault_when_loaded(const fs::path& icd_file) {
  Process child(this_program(), {"devices", "--load-driver", icd_file.string(), "--quiet"});
  const auto end = std::chrono::steady_clock::now() + kLoading;
  while (child.running() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const bool late = child.running();
  if (late) child.kill();
  Process::Result result = child.end();
  stop_if_interrupted();  // the child's end says nothing then
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

/// Returns the .icd files of OCL_ICD_VENDORS (a file, a folder, or a driver's library in their
/// place), by default of /etc/OpenCL/vendors, in the order of their names.
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

/// Loads each driver in a child process and returns those that fail. Without set_helper_program()
/// it loads none.
std::vector<FaultyDriver> faulty_drivers() {
  std::vector<FaultyDriver> faulty;
  for (const fs::path& file : driver_files()) {
    std::string reason = library_of(file).empty() ? "names no library" : "";
    if (reason.empty() && !this_program().empty()) reason = fault_when_loaded(file);
    if (!reason.empty()) faulty.push_back({file.string(), reason});
  }
  return faulty;
}

/// The work of that child process. Throws Error(device) with the linker's words.
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

/// From now on the OpenCL loader finds all drivers except `faulty`: links their .icd files into
/// `folder`, which has none before.
void leave_out(const std::vector<FaultyDriver>& faulty, const fs::path& folder) {
  for (const fs::path& file : driver_files())
    if (std::ranges::count(faulty, file.string(), &FaultyDriver::file) == 0)
      fs::create_symlink(fs::absolute(file), folder / file.filename());
  ::setenv("OCL_ICD_VENDORS", folder.c_str(), 1);
}

}  // namespace

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Device, index, platform_index, device_index, platform, name,
                                   driver, version, type, compute_units, max_alloc_bytes, images,
                                   image3d_writes, int64_atomics, fp64, profiling_valid, missing)

namespace {

/// The most work-items of a work-group, 0 if the driver fails to answer; a kernel that needs many
/// registers may have fewer.
std::size_t work_group_of(const Device& device) {
  std::size_t most = 0;
  static_cast<void>(
      clGetDeviceInfo(device.handle(), CL_DEVICE_MAX_WORK_GROUP_SIZE, sizeof most, &most, nullptr));
  return most;
}

nlohmann::json to_json(const DeviceList& list, const std::vector<FaultyDriver>& faulty) {
  nlohmann::json drivers = nlohmann::json::array();
  for (const FaultyDriver& driver : faulty)
    drivers.push_back({{"file", driver.file}, {"reason", driver.reason}});
  nlohmann::json devices = nlohmann::json::array();
  for (const Device& d : list.devices) {
    devices.push_back(nlohmann::json(d));
    devices.back()["max_work_group_size"] = work_group_of(d);
    devices.back()["supported"] = d.supported();
  }
  return {{"schema", 1},
          {"devices", devices},
          {"platforms_without_devices", list.platforms_without_devices},
          {"faulty_drivers", drivers}};
}

const char* yes_no(bool value) {
  return value ? "yes" : "no";
}

void print(const DeviceList& list) {
  for (const Device& d : list.devices) {
    print_data("{}  {}\n   {}, {}, driver {}\n", d.index, d.name, d.platform, d.version, d.driver);
    print_data(
        "   {}, {} compute units, work-groups of {}, {} MiB a buffer; images {}, 3-D image writes "
        "{}\n",
        d.type, d.compute_units, work_group_of(d), d.max_alloc_bytes >> 20, yes_no(d.images),
        yes_no(d.image3d_writes));
    print_data("   64-bit atomics {}, fp64 {}, events {}\n", yes_no(d.int64_atomics),
               yes_no(d.fp64), d.profiling_valid ? "valid" : "implausible: wall time instead");
    if (!d.supported()) print_data("   unsupported, lacks: {}\n", fmt::join(d.missing, ", "));
  }
  for (const std::string& name : list.platforms_without_devices)
    print_data("-  {}: no device\n", name);
}

}  // namespace

void add_devices(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand(
      "devices", "List all OpenCL devices and their capabilities; with --device, the selected one");
  auto format = std::make_shared<std::string>();
  add_format(*command, *format);
  auto driver = std::make_shared<std::string>();
  add(*command, "--load-driver", "FILE.icd", *driver, "load this driver and end")->group("");
  command->callback([format, driver, &shared] {
    if (!driver->empty()) return load_driver(*driver);
    const std::vector<FaultyDriver> faulty = faulty_drivers();
    const char* drivers = std::getenv("OCL_ICD_VENDORS");
    const std::string set = drivers == nullptr ? "" : drivers;
    std::optional<ScratchFolder> others;
    if (!faulty.empty()) leave_out(faulty, others.emplace().path());
    DeviceList list = list_devices();
    ::setenv("OCL_ICD_VENDORS", set.c_str(), 1);  // messages name it
    if (!shared.device.empty()) {
      list = {{choose_device(list.devices, shared.device)}, {}};
    }
    if (*format == "json") {
      print_json(
          to_json(list, faulty).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) +
          "\n");
    } else {
      print(list);
      for (const FaultyDriver& each : faulty) print_data("-  {}: {}\n", each.file, each.reason);
    }
    if (list.devices.empty()) (void)choose_device(list.devices, {});  // throws
  });
}

}  // namespace clpv
