// SPDX-License-Identifier: MIT
// Records what a session builds and launches, as a folder that host/verify/replay/replay.c replays.
#pragma once

#include <CL/opencl.hpp>
#include <filesystem>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace clpv {

/// Values that one number of an output may have.
struct Range {
  double low = -std::numeric_limits<double>::infinity(),
         high = std::numeric_limits<double>::infinity();
};
using Ranges = std::vector<Range>;

/// Writes the folder's capsule.txt before each build and launch, so that a process that ends there
/// leaves it. Contents of buffers and images are read before and after each launch: what the host
/// changed between launches becomes a command `write`. Methods throw Error(run_time) that begins
/// with kRecording if the folder cannot be written or would become larger than kMaxBytes.
class Recorder {
 public:
  static constexpr std::size_t kMaxBytes = 4 << 20;
  static constexpr std::string_view kRecording = "capsule: ";

  /// `queue`: of the session, in order.
  Recorder(std::filesystem::path folder, cl::CommandQueue queue);

  /// Before it is built. `file`: its kernel file.
  void add_program(const std::string& file, const std::string& options, const std::string& text);
  /// The program of the last add_program(), with the options that the driver took.
  void built(const cl::Program& program);

  void set_argument(const cl::Kernel& kernel, cl_uint index, std::span<const std::byte> value);
  void set_argument(const cl::Kernel& kernel, cl_uint index, const cl::Memory& memory);
  /// Before and after a launch.
  void begin_launch(const cl::Kernel& kernel, const cl::NDRange& global, const cl::NDRange& local);
  void end_launch();

  /// Compares the memory's numbers here: one range each, from the first on. `kind`: float, half,
  /// uint or bits, where each byte must have all bits of `low` and none outside `high`.
  void expect(const cl::Memory& memory, std::string_view kind, const Ranges& ranges);

 private:
  struct Known {
    cl::Memory handle;  ///< keeps it, so that no other gets its address
    std::size_t number = 0;
    std::vector<char> contents = {};
  };
  struct Argument {
    std::string value;  ///< hexadecimal
    cl::Memory memory;  ///< null for values
  };
  Known& known(const cl::Memory& memory);
  void note_contents(const cl::Memory& memory);
  std::string stored(std::span<const char> bytes, const char* name);
  void write(const std::string& name, std::string_view bytes);
  void write_commands();

  std::filesystem::path folder_;
  cl::CommandQueue queue_;
  std::vector<std::string> commands_;
  std::map<cl_mem, Known> memories_;
  std::vector<cl::Program> programs_;
  std::map<cl_kernel, std::map<cl_uint, Argument>> arguments_;
  std::vector<cl::Memory> launched_;          ///< memories of the launch in progress
  std::map<std::string, std::string> files_;  ///< names by contents
  std::size_t bytes_ = 0, program_command_ = 0;
};

}  // namespace clpv
