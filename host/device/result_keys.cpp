// SPDX-License-Identifier: MIT
#include "device/result_keys.hpp"

#include <nlohmann/json.hpp>

#include "basis/basis.hpp"
#include "device/driver_cache.hpp"
#include "device/program.hpp"
#include "support/fingerprint.hpp"
#include "support/json_schema.hpp"

namespace clpv {

std::string pixels_key(const Device& device, const RenderOptions& options) {
  static const std::string program = program_fingerprint();
  Fingerprint print;
  print.add(program).add(device.platform).add(device.platform_version).add(device.name);
  print.add(device.version).add(device.driver).add(device.lanes);
  print.add(driver_settings(DriverSettings::compilation)).add(to_json(options).dump());
  if (!options.centres.empty()) print.add(read_json(options.centres, kCentresBytes).dump());
  add_kernels(print);
  return print.hex();
}

std::string times_key(const Device& device, const RenderOptions& options, int processors) {
  Fingerprint print;
  print.add(pixels_key(device, options)).add(driver_settings(DriverSettings::all));
  return print.add(device.compute_units).add(processors).hex();
}

}  // namespace clpv
