// SPDX-License-Identifier: MIT
#include "device/recorder.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "support/error.hpp"
#include "support/output_file.hpp"

namespace clpv {
namespace {

constexpr const char* kCommands =
    "# Commands, one a line, in order. Numbers are decimal, BYTES of a value hexadecimal.\n"
    "#   buffer MEMORY BYTES\n"
    "#   image3d MEMORY ORDER TYPE WIDTH HEIGHT DEPTH BYTES   a texel has BYTES\n"
    "#   image1d MEMORY ORDER TYPE WIDTH BUFFER               an image of a buffer\n"
    "#   write MEMORY FILE       zeros follow a shorter file; FILE -: only zeros\n"
    "#   program PROGRAM FILE OPTION...                       builds it\n"
    "#   launch PROGRAM KERNEL DIMENSIONS GLOBAL... LOCAL... ARGUMENT...\n"
    "#                           an argument is mMEMORY, or vBYTES of a value\n"
    "#   expect MEMORY KIND FILE FILE: the least and the largest value (two floats) of each "
    "number;\n"
    "#                           KIND: float, half, uint or bits (bytes, from their least to their "
    "largest bits)\n";

std::string sizes_of(const cl::NDRange& range) {
  return fmt::format("{}", fmt::join(range.get(), range.get() + range.dimensions(), " "));
}

std::string hexadecimal(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte byte : bytes) text += fmt::format("{:02x}", static_cast<unsigned>(byte));
  return text;
}

std::array<cl::size_type, 3> extent_of(const cl::Memory& memory) {
  const cl::Image& image = static_cast<const cl::Image&>(memory);
  return {image.getImageInfo<CL_IMAGE_WIDTH>(), image.getImageInfo<CL_IMAGE_HEIGHT>(),
          image.getImageInfo<CL_IMAGE_DEPTH>()};
}

std::string command_of(const cl::Memory& memory, std::size_t number, std::size_t buffer) {
  const cl_mem_object_type type = memory.getInfo<CL_MEM_TYPE>();
  if (type == CL_MEM_OBJECT_BUFFER)
    return fmt::format("buffer {} {}", number, memory.getInfo<CL_MEM_SIZE>());
  const cl::Image& image = static_cast<const cl::Image&>(memory);
  const auto format = image.getImageInfo<CL_IMAGE_FORMAT>();
  const auto extent = extent_of(memory);
  const std::string texel =
      fmt::format("{} {} {}", number, format.image_channel_order, format.image_channel_data_type);
  if (type == CL_MEM_OBJECT_IMAGE1D_BUFFER)
    return fmt::format("image1d {} {} {}", texel, extent[0], buffer);
  return fmt::format("image3d {} {} {}", texel, fmt::join(extent, " "),
                     image.getImageInfo<CL_IMAGE_ELEMENT_SIZE>());
}

/// The buffer of a 1-D image; otherwise null.
cl::Memory buffer_of(const cl::Memory& memory) {
  if (memory.getInfo<CL_MEM_TYPE>() != CL_MEM_OBJECT_IMAGE1D_BUFFER) return {};
  return cl::Memory(memory.getInfo<CL_MEM_ASSOCIATED_MEMOBJECT>());
}

std::vector<char> contents_of(const cl::CommandQueue& queue, const cl::Memory& memory) {
  if (memory.getInfo<CL_MEM_TYPE>() == CL_MEM_OBJECT_BUFFER) {
    std::vector<char> bytes(memory.getInfo<CL_MEM_SIZE>());
    queue.enqueueReadBuffer(static_cast<const cl::Buffer&>(memory), CL_TRUE, 0, bytes.size(),
                            bytes.data());
    return bytes;
  }
  const auto extent = extent_of(memory);
  const cl::Image& image = static_cast<const cl::Image&>(memory);
  std::vector<char> bytes(extent[0] * extent[1] * extent[2] *
                          image.getImageInfo<CL_IMAGE_ELEMENT_SIZE>());
  queue.enqueueReadImage(image, CL_TRUE, {0, 0, 0}, extent, 0, 0, bytes.data());
  return bytes;
}

}  // namespace

Recorder::Recorder(std::filesystem::path folder, cl::CommandQueue queue)
    : folder_(std::move(folder)), queue_(std::move(queue)) {
  write_commands();
}

void Recorder::add_program(const std::string& file, const std::string& options,
                           const std::string& text) {
  const std::string name =
      fmt::format("{}-{}", programs_.size(), std::filesystem::path(file).filename().string());
  write(name, text);
  program_command_ = commands_.size();
  commands_.push_back(fmt::format("program {} {} {}", programs_.size(), name, options));
  programs_.emplace_back();
  write_commands();
}

void Recorder::built(const cl::Program& program) {
  programs_.back() = program;
  const auto device = program.getInfo<CL_PROGRAM_DEVICES>().front();
  const auto options = program.getBuildInfo<CL_PROGRAM_BUILD_OPTIONS>(device);
  std::string& command = commands_[program_command_];
  command.erase(command.find(' ', command.find(' ', command.find(' ') + 1) + 1) + 1);
  command += options.c_str();
}

void Recorder::set_argument(const cl::Kernel& kernel, cl_uint index,
                            std::span<const std::byte> value) {
  arguments_[kernel()][index] = {hexadecimal(value), {}};
}

void Recorder::set_argument(const cl::Kernel& kernel, cl_uint index, const cl::Memory& memory) {
  arguments_[kernel()][index] = {{}, memory};
}

Recorder::Known& Recorder::known(const cl::Memory& memory) {
  if (const auto found = memories_.find(memory()); found != memories_.end()) return found->second;
  const cl::Memory buffer = buffer_of(memory);
  const std::size_t below = buffer() == nullptr ? 0 : known(buffer).number;
  const std::size_t number = memories_.size();
  commands_.push_back(command_of(memory, number, below));
  return memories_[memory()] = {memory, number};
}

/// Adds a `write` if the contents are not those that the commands so far leave.
void Recorder::note_contents(const cl::Memory& memory) {
  Known& there = known(memory);
  if (const cl::Memory buffer = buffer_of(memory); buffer() != nullptr)
    return note_contents(buffer);
  std::vector<char> now = contents_of(queue_, memory);
  if (now == there.contents) return;
  const auto end = std::find_if(now.rbegin(), now.rend(), [](char c) { return c != 0; }).base();
  const std::string file = end == now.begin() ? "-" : stored({now.begin(), end}, "data");
  commands_.push_back(fmt::format("write {} {}", there.number, file));
  there.contents = std::move(now);
}

void Recorder::begin_launch(const cl::Kernel& kernel, const cl::NDRange& global,
                            const cl::NDRange& local) {
  std::string words;
  launched_.clear();
  for (const auto& [index, argument] : arguments_[kernel()]) {
    if (argument.memory() == nullptr) {
      words += " v" + argument.value;
      continue;
    }
    note_contents(argument.memory);
    words += fmt::format(" m{}", known(argument.memory).number);
    launched_.push_back(argument.memory);
  }
  const auto program = std::ranges::find(programs_, kernel.getInfo<CL_KERNEL_PROGRAM>()(),
                                         [](const cl::Program& p) { return p(); });
  commands_.push_back(fmt::format("launch {} {} {} {} {}{}", program - programs_.begin(),
                                  kernel.getInfo<CL_KERNEL_FUNCTION_NAME>().c_str(),
                                  global.dimensions(), sizes_of(global), sizes_of(local), words));
  write_commands();
}

void Recorder::end_launch() {
  for (const cl::Memory& memory : launched_)
    if (buffer_of(memory)() == nullptr) known(memory).contents = contents_of(queue_, memory);
}

void Recorder::expect(const cl::Memory& memory, std::string_view kind, const Ranges& ranges) {
  // Floats outside of the range of doubles.
  std::vector<float> floats;
  for (const Range& range : ranges) {
    auto low = static_cast<float>(range.low), high = static_cast<float>(range.high);
    if (low > range.low) low = std::nextafter(low, -INFINITY);
    if (high < range.high) high = std::nextafter(high, INFINITY);
    floats.insert(floats.end(), {low, high});
  }
  const std::span bytes(reinterpret_cast<const char*>(floats.data()),
                        floats.size() * sizeof(float));
  note_contents(memory);
  commands_.push_back(
      fmt::format("expect {} {} {}", known(memory).number, kind, stored(bytes, "expected")));
  write_commands();
}

/// Returns the file with these bytes, which it writes if there is none.
std::string Recorder::stored(std::span<const char> bytes, const char* name) {
  const std::string_view text(bytes.data(), bytes.size());
  std::string& file = files_[std::string(text)];
  if (!file.empty()) return file;
  const std::string made = fmt::format("{}-{}.bin", name, files_.size());
  write(made, text);
  return file = made;
}

void Recorder::write(const std::string& name, std::string_view bytes) {
  bytes_ += bytes.size();
  if (bytes_ > kMaxBytes)
    throw Error(ExitCode::run_time, "{}found more than {} MiB of programs and data; allowed: less",
                kRecording, kMaxBytes >> 20);
  try {
    write_file(folder_ / name, bytes, OutputFile::Kind::entry);
  } catch (const Error& error) {
    throw Error(ExitCode::run_time, "{}{}", kRecording, error.what());
  }
}

void Recorder::write_commands() {
  const std::string text = fmt::format("{}{}\n", kCommands, fmt::join(commands_, "\n"));
  try {
    write_file(folder_ / "capsule.txt", text, OutputFile::Kind::entry);
  } catch (const Error& error) {
    throw Error(ExitCode::run_time, "{}{}", kRecording, error.what());
  }
}

}  // namespace clpv
