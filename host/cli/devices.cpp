// SPDX-License-Identifier: MIT
// clpv devices: lists all OpenCL devices and their capabilities.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "device/device.hpp"
#include "support/error.hpp"
#include "support/print.hpp"

namespace clpv {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Device, index, platform_index, device_index, platform, name,
                                   driver, version, type, compute_units, max_alloc_bytes, images,
                                   image3d_writes, int64_atomics, fp64, profiling_valid, missing)

namespace {

nlohmann::json to_json(const DeviceList& list) {
  nlohmann::json devices = nlohmann::json::array();
  for (const Device& d : list.devices) {
    devices.push_back(nlohmann::json(d));
    devices.back()["supported"] = d.supported();
  }
  return {{"schema", 1},
          {"devices", devices},
          {"platforms_without_devices", list.platforms_without_devices}};
}

const char* yes_no(bool value) {
  return value ? "yes" : "no";
}

void print(const DeviceList& list) {
  for (const Device& d : list.devices) {
    print_data("{}  {}\n   {}, {}, driver {}\n", d.index, d.name, d.platform, d.version, d.driver);
    print_data("   {}, {} compute units, {} MiB a buffer; images {}, 3-D image writes {}\n", d.type,
               d.compute_units, d.max_alloc_bytes >> 20, yes_no(d.images),
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
  command->callback([format, &shared] {
    DeviceList list = list_devices();
    if (!shared.device.empty()) {
      list = {{choose_device(list.devices, shared.device)}, {}};
    }
    if (*format == "json") {
      print_json(to_json(list).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) +
                 "\n");
    } else {
      print(list);
    }
    if (list.devices.empty())
      throw Error(ExitCode::device,
                  "no OpenCL device found; on Debian: apt install pocl-opencl-icd");
  });
}

}  // namespace clpv
