// SPDX-License-Identifier: MIT
// List of OpenCL devices.
#pragma once

#include <string>
#include <vector>

namespace clpv {

/// One OpenCL device of one platform.
struct DeviceDescription {
  int index = 0;  ///< position in all_devices(); Renderer accepts it as text
  std::string name, platform, driver;
  std::string type;  ///< "cpu", "gpu", "accelerator", ...
  /// Required capabilities that it lacks; empty: clpv can use the device.
  std::vector<std::string> missing;
};

/// Returns all devices of all platforms. Without any device the list is empty; that is not an
/// error.
std::vector<DeviceDescription> all_devices();

}  // namespace clpv
