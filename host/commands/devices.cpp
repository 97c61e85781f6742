// clpv devices: every OpenCL device, and what it can do.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "device/device.hpp"

namespace clpv {
namespace {

nlohmann::json to_json(const DeviceList& list) {
  nlohmann::json devices = nlohmann::json::array();
  for (const Device& d : list.devices) {
    devices.push_back({{"index", d.index},
                       {"platform_index", d.platform_index},
                       {"device_index", d.device_index},
                       {"platform", d.platform},
                       {"name", d.name},
                       {"driver", d.driver},
                       {"version", d.version},
                       {"type", d.type},
                       {"compute_units", d.compute_units},
                       {"max_alloc_bytes", d.max_alloc_bytes},
                       {"images", d.images},
                       {"image3d_writes", d.image3d_writes},
                       {"int64_atomics", d.int64_atomics},
                       {"fp64", d.fp64},
                       {"profiling_valid", d.profiling_valid},
                       {"supported", d.supported()},
                       {"missing", d.missing}});
  }
  return {{"schema", 1}, {"devices", devices}, {"platforms_without_devices", list.platforms_without_devices}};
}

void print(const DeviceList& list) {
  for (const Device& d : list.devices) {
    fmt::print("{}  {}\n   {}, {}, driver {}\n", d.index, d.name, d.platform, d.version, d.driver);
    fmt::print("   {}, {} compute units, {} MiB a buffer; images {}, 3-D image writes {}, events {}\n",
               d.type, d.compute_units, d.max_alloc_bytes >> 20, d.images ? "yes" : "no",
               d.image3d_writes ? "yes" : "no",
               d.profiling_valid ? "valid" : "implausible (wall time instead)");
    if (!d.supported()) fmt::print("   unsupported, lacks: {}\n", fmt::join(d.missing, ", "));
  }
  for (const std::string& name : list.platforms_without_devices) fmt::print("-  {}: no device\n", name);
}

}  // namespace

void add_devices(CLI::App& app, Shared&) {
  CLI::App* command = app.add_subcommand("devices", "List every OpenCL device and what it can do");
  auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "JSON on stdout");
  command->callback([json] {
    const DeviceList list = list_devices();
    if (*json) {
      fmt::print("{}\n", to_json(list).dump(2));
    } else {
      print(list);
    }
  });
}

}  // namespace clpv
