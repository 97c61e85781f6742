// SPDX-License-Identifier: MIT
// clpv devices: lists all OpenCL devices and their capabilities.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "device/device.hpp"
#include "device/driver_files.hpp"
#include "support/error.hpp"
#include "support/print.hpp"
#include "support/scratch_folder.hpp"

namespace clpv {
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
    std::optional<ScratchFolder> others;
    if (!faulty.empty()) leave_out(faulty, others.emplace().path());
    DeviceList list = list_devices();
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
