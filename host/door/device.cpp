// SPDX-License-Identifier: MIT
#include "clpv/device.hpp"

#include "device/device.hpp"

namespace clpv {

std::vector<DeviceDescription> all_devices() {
  std::vector<DeviceDescription> all;
  for (const Device& device : list_devices().devices)
    all.push_back({device.index, device.name, device.platform, device.driver, device.type, device.missing});
  return all;
}

}  // namespace clpv
