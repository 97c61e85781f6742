// SPDX-License-Identifier: MIT
#include "device/device.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>

#include "device/cl_error.hpp"
#include "device/driver_cache.hpp"
#include "device/timeline.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

/// A string of a driver without blanks and zeros at its end.
std::string without_padding(std::string text) {
  while (!text.empty() &&
         (std::isspace(static_cast<unsigned char>(text.back())) || text.back() == '\0'))
    text.pop_back();
  return text;
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return out;
}

std::string type_name(cl_device_type type) {
  if (type & CL_DEVICE_TYPE_CPU) return "cpu";
  if (type & CL_DEVICE_TYPE_GPU) return "gpu";
  if (type & CL_DEVICE_TYPE_ACCELERATOR) return "accelerator";
  return "other";
}

/// Returns true if events have plausible times: each takes some, the device's clock says that the
/// host waited between two of them, and fills of a busy queue take a fair share of the host's time.
bool profiling_is_plausible(const cl::Device& handle) {
  using Clock = std::chrono::steady_clock;
  using Ns = std::chrono::duration<double, std::nano>;
  constexpr std::chrono::milliseconds kWait{1};  // far above the resolution of clocks
  constexpr std::size_t kBytes = 1 << 20, kMost = 64 << 20;
  constexpr cl_ulong kLeast = 100;  // [ns]: 1 MiB would be filled at 10 TB/s
  constexpr std::size_t kFills = 16, kTries = 3;
  constexpr double kShare = 1. / 16;  // gaps between launches and a busy host take the rest
  try {
    cl::Context context(handle);
    cl::CommandQueue queue(context, handle, CL_QUEUE_PROFILING_ENABLE);
    const std::size_t most =
        std::clamp<std::size_t>(handle.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>() / 4, kBytes, kMost);
    cl::Buffer buffer(context, CL_MEM_READ_WRITE, most);
    const auto fill = [&](std::size_t bytes) {
      cl::Event event;
      queue.enqueueFillBuffer(buffer, cl_uchar{0}, 0, bytes, nullptr, &event);
      return event;
    };
    const auto filled = [&] {
      const cl::Event event = fill(kBytes);
      queue.finish();
      const EventTimes times = times_of(event);
      return times.end - times.start >= kLeast ? times : EventTimes();
    };
    const Clock::time_point begun = Clock::now();
    const EventTimes first = filled();
    const Clock::time_point waited = Clock::now();
    std::this_thread::sleep_for(kWait);
    const Ns least = Clock::now() - waited;
    const EventTimes second = filled();
    const Ns most_between = Clock::now() - begun;
    const double between = static_cast<double>(second.start) - static_cast<double>(first.end);
    if (!first.valid || !second.valid || between < least.count() * (1 - kClockTolerance) ||
        between > most_between.count() * (1 + kClockTolerance))
      return false;
    // Fills grow until the host needs kWait for them, so that launches do not hide their time.
    for (std::size_t bytes = kBytes, tries = 0; tries < kTries;) {
      const Clock::time_point start = Clock::now();
      std::vector<cl::Event> events;
      for (std::size_t i = 0; i < kFills; ++i) events.push_back(fill(bytes));
      queue.finish();
      const Ns elapsed = Clock::now() - start;
      double sum = 0;
      for (const cl::Event& event : events)
        sum += times_of(event).valid ? times_of(event).ms() * 1e6 : NAN;
      if (sum >= elapsed.count() * kShare) return true;
      const bool grows = elapsed < kWait && bytes < most;
      bytes = grows ? std::min(2 * bytes, most) : bytes;
      tries += grows ? 0 : 1;
    }
    return false;
  } catch (const cl::Error&) {
    return false;
  }
}

/// Device::lanes of a device of this type.
int lanes_of(std::string_view type) {
  const char* environment = std::getenv("CLPV_LANES");
  const std::string_view lanes = environment != nullptr ? environment : "auto";
  if (lanes == "1") return 1;
  if (lanes == "8") return 8;
  if (lanes != "auto" && !lanes.empty())
    throw Error(ExitCode::usage, "CLPV_LANES: {}; allowed: auto, 1 or 8", lanes);
  return type == "cpu" ? 8 : 1;
}

/// Queries all properties of a device. Throws cl::Error if the driver fails to answer.
void describe(Device& device) {
  const cl::Device& handle = device.handle;
  device.name = without_padding(handle.getInfo<CL_DEVICE_NAME>());
  device.driver = without_padding(handle.getInfo<CL_DRIVER_VERSION>());
  device.version = without_padding(handle.getInfo<CL_DEVICE_VERSION>());
  device.type = type_name(handle.getInfo<CL_DEVICE_TYPE>());
  device.lanes = lanes_of(device.type);
  device.compute_units = handle.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
  device.max_alloc_bytes = handle.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  device.memory_bytes = handle.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  device.images = handle.getInfo<CL_DEVICE_IMAGE_SUPPORT>() == CL_TRUE;
  const std::string extensions = handle.getInfo<CL_DEVICE_EXTENSIONS>();
  const auto has = [&](const char* name) { return extensions.find(name) != std::string::npos; };
  device.image3d_writes = device.images && has("cl_khr_3d_image_writes");
  device.int64_atomics = has("cl_khr_int64_base_atomics") && has("cl_khr_int64_extended_atomics");
  device.fp64 = has("cl_khr_fp64");
  if (handle.getInfo<CL_DEVICE_AVAILABLE>() != CL_TRUE) device.missing.push_back("available");
  if (handle.getInfo<CL_DEVICE_COMPILER_AVAILABLE>() != CL_TRUE)
    device.missing.push_back("compiler");
  int major = 0, minor = 0;
  if (std::sscanf(device.version.c_str(), "OpenCL %d.%d", &major, &minor) != 2 ||
      major * 10 + minor < 12) {
    device.missing.push_back("OpenCL 1.2");
  }
  if (handle.getInfo<CL_DEVICE_ENDIAN_LITTLE>() != CL_TRUE)
    device.missing.push_back("little endian");
  device.profiling_valid = device.supported() && profiling_is_plausible(handle);
}

std::string summary(const std::vector<Device>& devices) {
  std::string text;
  for (const Device& device : devices) {
    text += fmt::format("\n  {}: {} ({})", device.index, device.name, device.platform);
    if (!device.supported()) text += fmt::format(", lacks: {}", fmt::join(device.missing, ", "));
  }
  return text;
}

bool matches(const Device& device, std::string_view choice) {
  if (const auto index = parse_number<int>(choice)) return device.index == *index;
  if (const auto colon = choice.find(':'); colon != std::string_view::npos) {
    const auto platform = parse_number<int>(choice.substr(0, colon)),
               in_platform = parse_number<int>(choice.substr(colon + 1));
    if (platform && in_platform)
      return device.platform_index == *platform && device.device_index == *in_platform;
  }
  std::string wanted = lower(choice);
  if (wanted == "pocl") wanted = "portable computing language";  // its platform's name
  return lower(device.name).find(wanted) != std::string::npos ||
         lower(device.platform).find(wanted) != std::string::npos;
}

DeviceList ask_platforms() {
  DeviceList list;
  std::vector<cl::Platform> platforms;
  try {
    cl::Platform::get(&platforms);
  } catch (const cl::Error&) {
    return list;  // the loader found no platform
  }
  for (std::size_t p = 0; p < platforms.size(); ++p) {
    std::vector<cl::Device> handles;
    try {
      platforms[p].getDevices(CL_DEVICE_TYPE_ALL, &handles);
    } catch (const cl::Error&) {
      handles.clear();  // CL_DEVICE_NOT_FOUND: common for Mesa's platforms
    }
    const std::string platform = without_padding(platforms[p].getInfo<CL_PLATFORM_NAME>());
    if (handles.empty()) list.platforms_without_devices.push_back(platform);
    for (std::size_t d = 0; d < handles.size(); ++d) {
      Device device;
      device.handle = handles[d];
      device.platform = platform;
      device.platform_version = without_padding(platforms[p].getInfo<CL_PLATFORM_VERSION>());
      device.index = list.devices.size();
      device.platform_index = p;
      device.device_index = d;
      try {
        describe(device);
      } catch (const cl::Error& error) {  // a broken driver must not hide other devices
        device.missing.push_back(
            fmt::format("a working {} ({})", error.what(), cl_error_name(error.err())));
      }
      list.devices.push_back(std::move(device));
    }
  }
  return list;
}

/// `choice`, or CLPV_DEVICE if `choice` is empty.
std::string_view choice_or_environment(std::string_view choice) {
  const char* environment = std::getenv("CLPV_DEVICE");
  return choice.empty() && environment != nullptr ? environment : choice;
}

/// Lists all devices. Throws Error(device) if platforms exist but none has a device, and as
/// list_devices().
std::vector<Device> found_devices() {
  DeviceList list = list_devices();
  if (list.devices.empty() && !list.platforms_without_devices.empty()) {
    throw Error(ExitCode::device,
                "no OpenCL device found; platforms without one: {} (PoCL has no device if it "
                "cannot write its cache, POCL_CACHE_DIR)",
                fmt::join(list.platforms_without_devices, ", "));
  }
  return std::move(list.devices);
}

}  // namespace

DeviceList list_devices() {
  choose_driver_cache();
  return ask_platforms();
}

Device choose_device(std::string_view choice) {
  return choose_device(found_devices(), choice_or_environment(choice));
}

std::vector<Device> choose_devices(std::string_view choice) {
  choice = choice_or_environment(choice);
  const std::vector<Device> devices = found_devices();
  std::vector<Device> chosen;
  if (choice.empty()) {
    const Device first = choose_device(devices, choice);
    std::ranges::copy_if(devices, std::back_inserter(chosen), [&](const Device& d) {
      return d.supported() && d.name == first.name && d.platform == first.platform;
    });
    return chosen;
  }
  std::ranges::copy_if(devices, std::back_inserter(chosen),
                       [&](const Device& d) { return d.supported() && matches(d, choice); });
  if (chosen.empty())
    chosen.push_back(choose_device(devices, choice));  // throws an error that says why none matches
  return chosen;
}

Device choose_device(const std::vector<Device>& devices, std::string_view choice) {
  if (devices.empty()) {
    const char* drivers = std::getenv("OCL_ICD_VENDORS");
    throw Error(ExitCode::device,
                "no OpenCL device found{}; on Debian: apt install pocl-opencl-icd; by pip: "
                "clpv[pocl]",
                drivers != nullptr && *drivers != '\0'
                    ? fmt::format(" by OCL_ICD_VENDORS={}", drivers)
                    : "");
  }
  if (choice.empty()) {
    const auto found =
        std::find_if(devices.begin(), devices.end(), [](const Device& d) { return d.supported(); });
    if (found != devices.end()) return *found;
    throw Error(ExitCode::device, "no supported OpenCL device among:{}", summary(devices));
  }
  std::vector<Device> matching;
  for (const Device& device : devices) {
    if (matches(device, choice)) matching.push_back(device);
  }
  if (matching.empty()) {
    throw Error(ExitCode::device, "no OpenCL device matches '{}'; available:{}", choice,
                summary(devices));
  }
  if (matching.size() > 1) {
    throw Error(ExitCode::device, "several OpenCL devices match '{}':{}", choice,
                summary(matching));
  }
  if (!matching[0].supported()) {
    throw Error(ExitCode::device, "device {} ({}) lacks: {}", matching[0].index, matching[0].name,
                fmt::join(matching[0].missing, ", "));
  }
  return matching[0];
}

Device device_of(const cl::Device& handle) {
  for (Device& listed : ask_platforms().devices) {
    if (listed.handle() == handle()) return std::move(listed);
  }
  Device device;
  device.handle = handle;
  const cl::Platform platform(handle.getInfo<CL_DEVICE_PLATFORM>());
  device.platform = without_padding(platform.getInfo<CL_PLATFORM_NAME>());
  device.platform_version = without_padding(platform.getInfo<CL_PLATFORM_VERSION>());
  describe(device);
  return device;
}

Device sub_device(const Device& device, unsigned units, unsigned index) {
  Device result = device;
  if (units == device.compute_units) return result;
  std::vector<cl_device_partition_property> by_counts = {CL_DEVICE_PARTITION_BY_COUNTS};
  by_counts.insert(by_counts.end(), index + 1, static_cast<cl_device_partition_property>(units));
  by_counts.insert(by_counts.end(), {CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0});
  std::vector<cl::Device> handles;
  try {
    result.handle.createSubDevices(by_counts.data(), &handles);
  } catch (const cl::Error&) {
    handles.clear();
  }
  if (handles.size() <= index)
    throw Error(ExitCode::device, "{} cannot be split into compute units", device.name);
  result.handle = handles[index];
  result.compute_units = units;
  return result;
}

nlohmann::json to_json(const Device& device) {
  return {{"platform", device.platform}, {"name", device.name}, {"driver", device.driver}};
}

}  // namespace clpv
