// SPDX-License-Identifier: MIT
// Which OpenCL devices there are, what they can do, and choosing one.
#pragma once

#include <CL/opencl.hpp>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace clpv {

/// One OpenCL device and the capabilities clpv asks about, each asked once.
struct Device {
  cl::Device handle;
  int index = 0;           ///< over all platforms
  int platform_index = 0;  ///< among all platforms, those without a device counted too
  int device_index = 0;    ///< within its platform
  std::string platform, platform_version, name, driver, version, type;
  unsigned compute_units = 0;
  std::uint64_t max_alloc_bytes = 0;
  std::uint64_t memory_bytes = 0;
  bool images = false;
  bool image3d_writes = false;
  bool int64_atomics = false;
  bool fp64 = false;
  bool profiling_valid = false;      ///< events tell plausible times (rusticl's say 1 ns)
  std::vector<std::string> missing;  ///< why clpv cannot use it; empty: supported

  bool supported() const { return missing.empty(); }
};

struct DeviceList {
  std::vector<Device> devices;
  std::vector<std::string> platforms_without_devices;
};

/// Every device of every platform. No OpenCL at all is an empty list, not an error.
DeviceList list_devices();

/// The device named by `choice`: an index "N", "PLATFORM:DEVICE", or a part of its name or platform (letter
/// case aside); empty: CLPV_DEVICE, else the first supported one. Throws Error(device) where none fits,
/// several fit, or the one that fits lacks something (named).
Device choose_device(std::string_view choice = {});

/// The same among given devices; CLPV_DEVICE is not asked.
Device choose_device(const std::vector<Device>& devices, std::string_view choice);

/// All that `choice` fits and that are supported, in their order; without one (CLPV_DEVICE is asked too) the first supported
/// one and those of its name and platform. Throws Error(device) where there is none.
std::vector<Device> choose_devices(std::string_view choice = {});

/// A part of `units` compute units, the `index`-th of such parts; the device itself where that is all it has.
/// Throws Error(device) where it cannot be split so.
Device part_of(const Device& device, unsigned units, unsigned index = 0);

}  // namespace clpv
