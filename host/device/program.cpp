// SPDX-License-Identifier: MIT
#include "device/program.hpp"

#include <chrono>
#include <map>
#include <mutex>
#include <regex>
#include <thread>

#include "device/cl_error.hpp"
#include "device/driver_cache.hpp"
#include "device/kernel_files.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

/// Retries of a build that fails without an error in the text. PoCL 3.1 fails so occasionally while
/// another process compiles the same text, because both write to PoCL's cache. Waits double from
/// kRetryWait on.
constexpr int kRetries = 5;
constexpr std::chrono::milliseconds kRetryWait{20};

constexpr std::string_view kStandard = "-cl-std=CL1.2 ";
constexpr const char* kImageProbe =
    "__kernel void probe(__read_only image3d_t image, __global float4* texel) {\n"
    "  texel[0] = read_imagef(image, (int4)(0));\n"
    "}\n";

/// Returns true if the log blames a line of the text: "inject.cl:12:3: error:", or "error:
/// inject.cl:12:3" of PoCL 6. Other errors are the driver's own.
bool blames_text(const std::string& log) {
  static const std::regex place(":[0-9]+: (fatal )?error:|error: [^\n]*:[0-9]+:[0-9]+");
  return std::regex_search(log, place);
}

/// A hint if the log shows that the driver cannot write its cache.
std::string cache_advice(const std::string& log) {
  if (log.find("No space left") != std::string::npos || driver_cache_is_full())
    return "\nthe disk of the driver's cache is full; POCL_CACHE_DIR names another folder for "
           "PoCL's";
  return {};
}

/// The compiler's log, or a note that the driver has none.
std::string build_log(const cl::Program& program, const Device& device) {
  try {
    return program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.handle);
  } catch (const cl::Error& error) {
    return fmt::format("(no log: {})", cl_error_name(error.err()));
  }
}

bool compiles(const cl::Context& context, const Device& device, const char* text,
              const std::string& options) {
  try {
    cl::Program(context, text).build(device.handle, options.c_str());
    return true;
  } catch (const cl::Error&) {
    return false;
  }
}

/// Returns true if the driver compiles kernels with images only without -cl-std=CL1.2, as PoCL 7.1
/// does. Compiles a probe, once per driver.
bool lacks_images_in_standard(const cl::Context& context, const Device& device) {
  static std::mutex mutex;
  static std::map<std::string, bool> known;
  const std::scoped_lock lock(mutex);
  const std::string driver = fmt::format("{} {}", device.platform_version, device.driver);
  if (const auto found = known.find(driver); found != known.end()) return found->second;
  const bool lacks = device.images &&
                     !compiles(context, device, kImageProbe, std::string(kStandard)) &&
                     compiles(context, device, kImageProbe, "");
  if (lacks)
    log_debug("driver {} has images only without {}: programs that need them are built so",
              device.driver, kStandard);
  return known[driver] = lacks;
}

}  // namespace

std::string program_text(const ProgramSource& source) {
  std::string text;
  if (!source.literals.defined().empty()) text += "#line 1 \"literals\"\n";
  for (const auto& [name, value] : source.literals.defined())
    text += fmt::format("#define {} {}\n", name, value);
  if (!source.generated.empty()) {
    text += assemble_kernel_source("lanes.h");  // whose types and CLPV_INLINE generated text uses
    text += "#line 1 \"generated\"\n" + source.generated + "\n";
  }
  return text + assemble_kernel_source(source.file);
}

cl::Program build_program(const cl::Context& context, const Device& device,
                          const ProgramSource& source, const std::string& text) {
  std::string options = source.options;
  for (int left = kRetries;;) {
    cl::Program program(context, text);
    try {
      program.build(device.handle, options.c_str());
      return program;
    } catch (const cl::Error& error) {
      const std::string log = build_log(program, device);
      if (!blames_text(log) && left > 0) {
        std::this_thread::sleep_for(kRetryWait * (1 << (kRetries - left--)));
      } else if (options.starts_with(kStandard) && lacks_images_in_standard(context, device)) {
        options.erase(0, kStandard.size());
      } else {
        throw Error(ExitCode::run_time,
                    "kernels/{} does not build on {} (driver {}) with '{}': {}\n{}{}", source.file,
                    device.name, device.driver, options, cl_error_name(error.err()), log,
                    cache_advice(log));
      }
    }
  }
}

}  // namespace clpv
