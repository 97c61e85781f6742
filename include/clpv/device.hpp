// SPDX-License-Identifier: MIT
// Which OpenCL devices there are.
#pragma once

#include <string>
#include <vector>

namespace clpv {

/// One device of one platform. `missing`: what it lacks for clpv, one capability each; empty: it can be used.
struct DeviceDescription {
  int index = 0;  ///< over all platforms; Renderer takes it as text, or a part of the name
  std::string name, platform, driver;
  std::string type;  ///< "cpu", "gpu", "accelerator", ...
  std::vector<std::string> missing;
};

/// Every device of every platform; none is an empty list, not an error.
std::vector<DeviceDescription> all_devices();

}  // namespace clpv
