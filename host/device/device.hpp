// SPDX-License-Identifier: MIT
// Lists OpenCL devices and their capabilities, and chooses one.
#pragma once

#include <CL/opencl.hpp>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace clpv {

/// One OpenCL device and the capabilities that clpv uses, queried once. Memory sizes are in bytes.
struct Device {
  cl::Device handle;
  int index = 0;           ///< over all platforms
  int platform_index = 0;  ///< among all platforms, including those without a device
  int device_index = 0;    ///< within its platform
  std::string platform, platform_version, name, driver, version, type;
  unsigned compute_units = 0;
  /// Pixels, cells or rays that a work-item processes: CLPV_LANES (1 or 8), else 8 on CPUs, 1
  /// elsewhere.
  int lanes = 8;
  std::uint64_t max_alloc_bytes = 0;
  std::uint64_t memory_bytes = 0;
  bool images = false;
  bool image3d_writes = false;
  bool int64_atomics = false;
  bool fp64 = false;
  bool profiling_valid = false;      ///< events report plausible times (rusticl reports 1 ns)
  std::vector<std::string> missing;  ///< features that clpv needs; empty: supported

  bool supported() const { return missing.empty(); }
  bool oclgrind() const { return platform == "Oclgrind"; }
};

struct DeviceList {
  std::vector<Device> devices;
  std::vector<std::string> platforms_without_devices;
};

/// Lists every device of every platform. Without OpenCL the list is empty; that is no error. Throws
/// Error(usage) if CLPV_LANES is neither auto, 1 nor 8, and as choose_driver_cache().
DeviceList list_devices();

/// Returns the device that matches `choice`: an index "N", "PLATFORM:DEVICE", or a substring of its
/// name or platform (case-insensitive). Empty: CLPV_DEVICE, else the first supported device. Throws
/// Error(device) if no device matches, several match, or the matching one lacks a feature (named).
Device choose_device(std::string_view choice = {});

/// The same among `devices`; ignores CLPV_DEVICE.
Device choose_device(const std::vector<Device>& devices, std::string_view choice);

/// Returns all supported devices that match `choice` (or CLPV_DEVICE), in order. If both are empty:
/// the first supported device and all with its name and platform. Throws Error(device) if there is
/// none.
std::vector<Device> choose_devices(std::string_view choice = {});

/// Describes a device that a caller has: as list_devices() does, or a sub-device as its parent's
/// platform has it.
Device device_of(const cl::Device& handle);

/// Returns the keys "platform", "name" and "driver".
nlohmann::json to_json(const Device& device);

/// Returns the `index`-th sub-device of `units` compute units, or the device itself if it has
/// exactly `units`. Throws Error(device) if the device cannot be split.
Device sub_device(const Device& device, unsigned units, unsigned index = 0);

}  // namespace clpv
