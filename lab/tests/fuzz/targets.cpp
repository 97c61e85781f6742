// SPDX-License-Identifier: MIT
// Fuzz targets, by name: each has a corpus/NAME. libFuzzer calls them with generated inputs
// (lab/scripts/fuzz); without it, this program gives a target each file of a folder (a test of
// every build):
//
//   fuzz FOLDER       the target is CLPV_FUZZ_TARGET
//
// An input is read or rejected. Whatever else happens is a finding: a crash, a sanitizer's report,
// an exception of another kind, or an error of another exit code than those a target allows. The
// input's name is printed before it is read.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "basis/basis.hpp"
#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "image/compare.hpp"
#include "image/image_header.hpp"
#include "image/image_io.hpp"
#include "scene/gltf_parts.hpp"
#include "scene/input.hpp"
#include "scene/load.hpp"
#include "sequence/times_file.hpp"
#include "support/error.hpp"
#include "support/log.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/tiny_images.hpp"

namespace clpv::fuzz {
namespace {

/// The process's folder for small files, in memory where possible.
const test::TemporaryFolder& folder() {
  static const bool in_memory = [] {
    if (std::filesystem::is_directory("/dev/shm")) ::setenv("TMPDIR", "/dev/shm", 0);
    return true;
  }();
  static const test::TemporaryFolder made;
  static_cast<void>(in_memory);
  return made;
}

/// Runs `read`; it may reject its input, but only with these exit codes.
template <typename Read>
void read_or_reject(std::initializer_list<ExitCode> allowed, Read&& read) {
  try {
    read();
  } catch (const Error& error) {
    for (const ExitCode code : allowed) {
      if (error.code() == code) return;
    }
    std::fprintf(stderr, "exit code %d is not this reader's: %s\n", static_cast<int>(error.code()),
                 error.what());
    std::abort();
  }
}

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// -------------------------------------------------------------------------------------------
// models

constexpr double kInstants[] = {-1, 0, 0.25, 1, 1e6};  // [s]; before, at and after keys

/// A triangle from 36 bytes of model.bin, which are zeros but for its corners.
constexpr std::string_view kSound =
    R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36, "uri":
"model.bin"}], "bufferViews": [{"buffer": 0, "byteLength": 36}], "accessors": [{"bufferView": 0, "componentType": 5126,
"count": 3, "type": "VEC3"}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}]})";

/// The same with image.png on it, and a scene of that under sky.hdr.
std::string textured() {
  nlohmann::json model = nlohmann::json::parse(kSound);
  model["images"][0]["uri"] = "image.png";
  model["textures"][0]["source"] = 0;
  model["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
  model["meshes"][0]["primitives"][0]["material"] = 0;
  return model.dump();
}

constexpr std::string_view kUnderSky = R"({"model": "textured.gltf", "sky": {"map": "sky.hdr"}})";

/// The files that URIs may name. An input that names one must not end there: they are read here,
/// and must not be rejected.
void write_neighbours() {
  const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::string bytes(reinterpret_cast<const char*>(corners), sizeof corners);
  bytes.resize(1024, '\0');
  folder().write("model.bin", bytes);
  folder().write("sound.gltf", kSound);
  folder().write("image.png", test::decode_base64(test::kPngGrey));
  folder().write("sky.hdr", std::string_view("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n"
                                             "\x40\x80\x20\x80\x80\x40\x20\x81"));  // two texels
  folder().write("textured.gltf", textured());
  MovingScene(folder().write("under_sky.json", kUnderSky));
}

/// Reads the scene under that name, and shows it at several instants.
void load_model(const std::string& name, std::string_view bytes) {
  static const bool written = (write_neighbours(), true);
  static_cast<void>(written);
  const std::filesystem::path path = folder().write(name, bytes);
  read_or_reject({ExitCode::bad_input}, [&] {
    MovingScene moving(path);
    for (const double instant : kInstants) {
      if (moving.moves()) read_or_reject({ExitCode::bad_input}, [&] { moving.pose(instant); });
    }
  });
}

/// A .gltf, text: loaded, and shown at some instants if it moves. Beside it are model.bin and
/// image.png for its URIs.
void gltf(std::string_view bytes) {
  load_model("model.gltf", bytes);
}

/// A .glb, chunks of JSON and of bytes: loaded as any model.
void glb(std::string_view bytes) {
  load_model("model.glb", bytes);
}

/// A scene file, with a valid model (sound.gltf) in the same folder.
void scene(std::string_view bytes) {
  load_model("scene.json", bytes);
}

// -------------------------------------------------------------------------------------------
// images

/// Small, since a decoder's time depends on the header.
constexpr ImageLimits kImageLimits{
    .file_bytes = 1 << 20, .side = 512, .channels = 32, .pixel_bytes = 1 << 22};

const char* name_for(std::string_view bytes) {
  if (bytes.starts_with("\x89P")) return "image.png";
  if (bytes.starts_with("#?")) return "image.hdr";
  return "image.exr";
}

void hold_against_header(const Image& image, const char* name,
                         std::span<const unsigned char> bytes) {
  std::int64_t channels = 0;
  for (const ExrHeader& part : read_exr_header(name, bytes)) {
    channels += part.channels;
    if (part.display.width() != image.width || part.display.height() != image.height) std::abort();
  }
  // Channels of one name count once for OpenEXR.
  if (channels < static_cast<std::int64_t>(image.channels.size())) std::abort();
}

/// An image as clpv compare reads it (EXR, PNG, HDR, by content), held against itself and against
/// its difference image. The walk through an EXR's headers must see what OpenEXR reads.
void image(std::string_view bytes) {
  const char* const name = name_for(bytes);
  const auto path = folder().write(name, bytes);
  read_or_reject({ExitCode::bad_input}, [&] {
    const Image image = read_image(path, kImageLimits);
    if (path.extension() == ".exr") hold_against_header(image, name, bytes_of(bytes));
    for (const std::string& layer : layers(image)) {
      read_or_reject({ExitCode::bad_input}, [&] {
        const Image one = extract_layer(image, layer, "fuzzed");
        if (!compare(one, "a", one, "b").identical) std::abort();
        difference_image(one, one, 15);
      });
    }
  });
}

/// A texture: bytes of a buffer, which say themselves whether they are a PNG, a JPEG or a WebP.
void texture(std::string_view bytes) {
  const auto header = read_image_header(bytes_of(bytes));
  // Larger images take a decoder seconds and find no further faults.
  const bool large = header && std::max(header->width, header->height) > kImageLimits.side;
  if (bytes.empty() || large) return;
  GltfDocument document;
  document.file = "fuzzed.glb";
  document.model.buffers.emplace_back().data.assign(bytes.begin(), bytes.end());
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = 0;
  view.byteLength = bytes.size();
  document.model.bufferViews.push_back(view);
  document.model.images.emplace_back().bufferView = 0;
  read_or_reject({ExitCode::bad_input}, [&] { load_textures(document, {{0, 0, 0}}); });
}

// ------------------------------------------------------------------------------------------
// options

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines = {"clpv"};
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    // As the shell would hand it over: up to the first NUL.
    lines.emplace_back(text.substr(0, std::min(end, text.find('\0'))));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

/// Those that can be chosen, since adding all takes some twenty times as long as parsing. All where
/// none is named, for the words about a misspelt one.
std::vector<Command> commands_named_in(const std::vector<std::string>& arguments) {
  const auto all = all_commands();
  std::vector<Command> named;
  std::ranges::copy_if(all, std::back_inserter(named), [&](const Command& command) {
    return std::ranges::any_of(arguments.begin() + 1, arguments.end(),
                               [&](const std::string& argument) {
                                 return argument.find(command.name) != std::string::npos;
                               });
  });
  return named.empty() ? std::vector(all.begin(), all.end()) : named;
}

void parse(std::vector<std::string> arguments) {
  CLI::App app;
  Shared shared;
  const std::vector<Command> commands = commands_named_in(arguments);
  add_commands(app, shared, commands);
  for (const Command& command : commands)
    app.get_subcommand(command.name);  // throws if it has another name
  // Before any command runs; their callbacks stay, since they hold what options are read into.
  app.parse_complete_callback([] { throw CLI::Success(); });
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  try {
    parse_command_line(app, static_cast<int>(pointers.size()), pointers.data());
  } catch (const CLI::Error&) {  // usage, or a question for help
  }
}

/// A command line, an argument a line: parsed as the program parses it, commands not run; and each
/// argument as a vector and as a box.
void command_line(std::string_view bytes) {
  const std::vector<std::string> arguments = lines_of(bytes);
  read_or_reject({ExitCode::usage}, [&] { parse(arguments); });
  for (const std::string& argument : arguments)
    read_or_reject({ExitCode::usage}, [&] { parse_vector(argument, "--option"); });
}

// ------------------------------------------------------------------------------------- smaller
// files

/// A file of --centres, up to the basis that is made of it.
void centres(std::string_view bytes) {
  const auto path = folder().write("centres.json", bytes);
  // Equal centres are an error of usage: lambda may come from the command line.
  read_or_reject({ExitCode::bad_input, ExitCode::usage}, [&] { load_basis(path.string()); });
}

/// A file of points for clpv query.
void points(std::string_view bytes) {
  const auto path = folder().write("points.csv", bytes);
  read_or_reject({ExitCode::bad_input}, [&] { read_points(path); });
}

/// A line of times.jsonl: skipped, or a frame's times that are written as they were read.
void times(std::string_view bytes) {
  const auto line = frame_line(std::string(bytes));
  if (!line) return;
  const std::string written = to_json(*line).dump();
  const auto again = frame_line(written);
  if (!again || to_json(*again).dump() != written || line->frame < 0) std::abort();
}

using Target = void (*)(std::string_view bytes);

Target chosen_target() {
  static const std::map<std::string_view, Target> kTargets = {
      {"centres", centres}, {"command_line", command_line},
      {"glb", glb},         {"gltf", gltf},
      {"image", image},     {"points", points},
      {"scene", scene},     {"texture", texture},
      {"times", times}};
  const char* name = std::getenv("CLPV_FUZZ_TARGET");
  const auto found = kTargets.find(name != nullptr ? name : "");
  if (found != kTargets.end()) return found->second;
  std::fprintf(stderr, "CLPV_FUZZ_TARGET: allowed: a folder of lab/tests/fuzz/corpus\n");
  std::exit(2);
}

}  // namespace
}  // namespace clpv::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const clpv::fuzz::Target target = clpv::fuzz::chosen_target();
  target({reinterpret_cast<const char*>(data), size});
  return 0;
}

#ifndef CLPV_LIBFUZZER
int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
    return 2;
  }
  std::size_t inputs = 0;
  for (const auto& file : std::filesystem::directory_iterator(argv[1])) {
    std::printf("%s\n", file.path().c_str());
    std::fflush(stdout);
    const std::string bytes = clpv::test::read_file(file.path());
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    ++inputs;
  }
  return inputs == 0 ? 1 : 0;
}
#endif
