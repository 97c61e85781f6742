// SPDX-License-Identifier: MIT
// Random values and combinations of every option of `clpv render`, on scenes at the limits of sizes
// and lights. Each run writes finite pixels, or ends with code 2 to 5 and a message that names an
// option or the scene file, within a minute of processor time.
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "image/image_io.hpp"
#include "options/render_options.hpp"
#include "options/scene_options.hpp"
#include "options/show.hpp"
#include "support/text.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_here.hpp"

namespace clpv::random_options_test {
using namespace test;

/// A sequence of choices, from a random generator.
class Choices {
 public:
  explicit Choices(int seed) : random_(static_cast<std::uint64_t>(seed)) {}

  bool one_in(std::size_t count) { return below(count) == 0; }
  template <typename List>
  const auto& of(const List& list) {
    return list[below(std::size(list))];
  }
  double between(double minimum, double maximum) {
    constexpr std::size_t kSteps = 1 << 16;
    return minimum + (maximum - minimum) * static_cast<double>(below(kSteps + 1)) / kSteps;
  }
  /// Uniform in the logarithm. Requires minimum > 0.
  double scale_between(double minimum, double maximum) {
    return std::clamp(std::exp(between(std::log(minimum), std::log(maximum))), minimum, maximum);
  }

 private:
  std::size_t below(std::size_t end) { return random_() % end; }
  std::mt19937_64 random_;
};

/// Upper bounds of options that only cost time or memory.
using Caps = std::map<std::string, double>;

/// Returns a value that the option table allows: at an end of the range, or inside it; "" for a
/// file.
std::string drawn_value(const OptionDescription& option, Choices& choices, const Caps& caps) {
  const std::string& allowed = option.allowed;
  if (allowed.find('|') != std::string::npos) {
    std::vector<std::string> names;
    std::istringstream all(allowed);
    for (std::string name; std::getline(all, name, '|');) names.push_back(name);
    return choices.of(names);
  }
  constexpr std::string_view kAbove = "greater than ", kBelow = " and less than ";
  constexpr double kInside = 1e-3;  // from the ends of an open range
  const bool open = allowed.starts_with(kAbove);
  const std::string_view between = open ? kBelow : std::string_view("..");
  const std::size_t start = open ? kAbove.size() : 0, middle = allowed.find(between);
  if (middle == std::string::npos) return {};
  const auto minimum =
                 parse_number<double>(std::string_view(allowed).substr(start, middle - start)),
             maximum =
                 parse_number<double>(std::string_view(allowed).substr(middle + between.size()));
  if (!minimum || !maximum) return {};
  const double first = *minimum + (open ? kInside : 0), end = *maximum - (open ? kInside : 0);
  const auto cap = caps.find(option.name);
  const double last = cap == caps.end() ? end : std::min(end, cap->second);
  double value = choices.one_in(8)   ? first
                 : choices.one_in(8) ? last
                 : first > 0         ? choices.scale_between(first, last)
                                     : choices.between(first, last);
  if (option.value.find('.') == std::string::npos)
    value = std::round(value);  // a whole number, like its default
  return fmt::format("{}", value);
}

constexpr double kPatience = 60;  // processor time [s], so that other processes do not count
constexpr int kLongKernels = 8;   // combinations of options that compile
constexpr int kNumbers = 12;      // combinations of other options with each
const Caps kCaps{{"width", 24},       {"height", 24},     {"grid", 12},    {"rsm-size", 48},
                 {"shadow-size", 48}, {"iterations", 12}, {"cascades", 4}, {"table-size", 1024}};

/// A number from the environment, for longer runs by hand.
int number_from(const char* variable, int usual) {
  const char* set = std::getenv(variable);
  return set == nullptr ? usual : std::atoi(set);
}

/// Options whose values change kernels' text, which then compile anew.
bool changes_kernels(const OptionDescription& option) {
  static const std::vector<std::string> kNumbers{"lambda", "grid", "table-size", "gather-offset",
                                                 "cascades"};
  return option.allowed.find('|') != std::string::npos ||
         std::ranges::count(kNumbers, option.name) > 0;
}

std::string words_of_options(const OptionValues& given) {
  std::string words;
  for (const auto& [name, value] : given) words += fmt::format(" --{} {}", name, value);
  return words;
}

struct RandomOptions : ::testing::Test {
  RandomOptions() {
    for (const double size : {1e-6, 1e-3, 1.0, 1e3, 1e7}) write_scenes(size);
  }

  /// A floor, a wall, and degenerate triangles: no area, no length, and thin ones; a mesh of none.
  void write_model(const std::string& name, double size) {
    GltfBuilder model;
    std::vector<float> positions;
    for (const auto& [x, y, z] : std::initializer_list<std::array<double, 3>>{
             {-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 1, -1}, {1, 1, -1}, {0, 1e-7, 0}})
      for (const double value : {x, y, z}) positions.push_back(static_cast<float>(value * size));
    const std::vector<std::uint16_t> indices{0, 1, 2, 0, 2, 3, 0, 3, 5, 0, 5,
                                             4, 6, 6, 6, 0, 0, 2, 0, 2, 6};
    const int position = model.accessor("VEC3", positions),
              index = model.accessor("SCALAR", indices);
    model.add("meshes",
              {{"primitives", {{{"attributes", {{"POSITION", position}}}, {"indices", index}}}}});
    model.add("nodes", {{"mesh", 0}});
    model.add("nodes", {{"name", "empty"}});
    model.finish(name + ".bin");
    folder_.write(name + ".bin", model.binary);
    folder_.write(name + ".gltf", model.document.dump());
  }

  void write_scenes(double size) {
    const std::string name = fmt::format("size{}", size);
    write_model(name, size);
    const auto point = [&](double x, double y, double z) {
      return json{x * size, y * size, z * size};
    };
    for (const std::size_t lights : {0, 1, 64}) {
      json scene{{"model", name + ".gltf"}};
      const json target = point(0.1, 0.4, -1);
      scene["cameras"] = {
          {{"name", "outside"}, {"eye", point(0.3, 0.6, 0.95)}, {"target", target}, {"near", 1e-6}},
          {{"name", "in-floor"},
           {"eye", point(0, 0, 0)},
           {"target", target},
           {"vertical_fov_degrees", 179.9}},
          {{"name", "upwards"}, {"eye", point(0.2, 0.3, 0.4)}, {"target", point(0.2, 1, -0.9)}}};
      if (lights == 0) scene["sky"] = {{"radiance", {1e10, 1e-30, 1}}};
      for (std::size_t i = 0; i < lights; ++i) {
        const double brightness = choices_.scale_between(1e-30, 1e9);
        const char* const kinds[] = {"directional", "point", "spot"};
        const std::string kind = choices_.of(kinds);
        json light{{"kind", kind}};
        light[kind == "directional" ? "illuminance_lux" : "intensity_candela"] = brightness;
        if (kind != "point")
          light["direction"] = {choices_.between(-1, 1), -1, choices_.between(-1, 1)};
        if (kind != "directional") light["position"] = point(choices_.between(-1, 1), 0.9, 0.1);
        scene["lights"].push_back(light);
      }
      const std::string file = fmt::format("{}-{}.json", name, lights);
      folder_.write(file, scene.dump());
      scenes_.push_back(file);
    }
  }

  OptionValues drawn(bool kernels, std::size_t one_in) {
    OptionValues given;
    for (const OptionDescription& option : list_options(RenderOptions{})) {
      if (changes_kernels(option) != kernels || !choices_.one_in(one_in)) continue;
      if (const std::string value = drawn_value(option, choices_, kCaps); !value.empty())
        given[option.name] = value;
    }
    return given;
  }

  /// Camera, sun, medium, view and extreme image sizes.
  std::string drawn_surroundings(OptionValues& given) {
    std::string words;
    const double size = choices_.scale_between(1e-6, 1e7);
    if (choices_.one_in(4)) {
      words += fmt::format(" --eye {},{},{} --target 0,0,0", size, choices_.between(-1, 1) * size,
                           size / 3);
      if (choices_.one_in(2)) words += fmt::format(" --fov {}", choices_.between(0.01, 179.9));
      if (choices_.one_in(2))
        words += fmt::format(" --near-plane {}", choices_.scale_between(1e-6, 1e7));
    } else {
      const char* const cameras[] = {"outside", "in-floor", "upwards"};
      words += fmt::format(" --camera {}", choices_.of(cameras));
    }
    if (choices_.one_in(4))
      words += fmt::format(" --sun 0.2,-1,0.1,{}", choices_.scale_between(1e-30, 1e15));
    if (choices_.one_in(6)) {
      const char* const media[] = {"0",           "1e6",   "1e6,1e6,0.9",
                                   "1e-6,0,-0.9", "0,1e6", "0.3,0.1,0.5"};
      words += fmt::format(" --medium {}", choices_.of(media));
    }
    words += fmt::format(" --view {}", choices_.of(names_of<Show>()));
    if (choices_.one_in(12)) {
      const std::pair<const char*, const char*> sizes[] = {
          {"1", "1"}, {"16384", "1"}, {"1", "16384"}};
      std::tie(given["width"], given["height"]) = choices_.of(sizes);
    }
    return words;
  }

  /// Renders a random scene. An option that has no effect with `compiled`, or contradicts it, is
  /// left out in further runs, until there is an image or another reason; returns true for an
  /// image.
  bool expect_image_or_reason(const OptionValues& compiled, OptionValues given) {
    for (const char* small : {"width", "height", "rsm-size", "shadow-size"})
      given.try_emplace(small, "16");
    const std::string scene = choices_.of(scenes_), surroundings = drawn_surroundings(given);
    for (;;) {
      const Outcome outcome =
          render(scene + surroundings + words_of_options(compiled) + words_of_options(given));
      if (outcome.exit_code == 0) return true;
      const auto named = std::ranges::find_if(
          given, [&](const auto& option) { return names(outcome.err, option.first); });
      if (named == given.end()) return false;
      given.erase(named);
    }
  }

  Outcome render(const std::string& words) {
    SCOPED_TRACE(words);
    const std::clock_t start = std::clock();
    const Outcome outcome = run_here("-q render " + words + " -o out.exr", folder_.path());
    EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, kPatience);
    ++codes_[outcome.exit_code];
    if (outcome.exit_code != 0) {
      EXPECT_THAT(outcome.exit_code, ::testing::AllOf(::testing::Ge(2), ::testing::Le(5)))
          << outcome.err;
      EXPECT_TRUE(names_an_option(outcome.err) || outcome.err.find(".json") != std::string::npos)
          << outcome.err;
      return outcome;
    }
    const Image image = read_image(folder_ / "out.exr");
    EXPECT_EQ(
        std::ranges::count_if(image.pixels, [](float value) { return !std::isfinite(value); }), 0)
        << "of " << image.pixels.size();
    std::filesystem::remove(folder_ / "out.exr");
    return outcome;
  }

  void expect_images_or_reasons(const OptionValues& compiled) {
    for (int n = 1; n < number_from("CLPV_RANDOM_NUMBERS", kNumbers); ++n)
      expect_image_or_reason(compiled, drawn(false, 2));
    EXPECT_GE(codes_[0], 1);
    for (const auto& [code, count] : codes_) RecordProperty(fmt::format("code_{}", code), count);
    fmt::print("exit codes: {}\n", codes_);
  }
  void expect_images_or_reasons(int kernels) {
    for (int k = 0; k < kernels;) {
      OptionValues compiled = drawn(true, 4);
      compiled.try_emplace("grid", "6");
      if (!expect_image_or_reason(compiled, {}))
        continue;  // they contradict each other, or the scene
      ++k;
      expect_images_or_reasons(compiled);
    }
    EXPECT_GE(codes_[0], kernels);
  }

  static bool names(const std::string& message, const std::string& option) {
    return message.find("--" + option + " ") != std::string::npos ||
           message.find(option + ": found") != std::string::npos;
  }

  static bool names_an_option(const std::string& message) {
    std::vector<std::string> options{"view",   "sun", "medium",     "eye",
                                     "target", "fov", "near-plane", "camera"};
    for (const OptionDescription& option : list_options(RenderOptions{}))
      options.push_back(option.name);
    return std::ranges::any_of(options,
                               [&](const std::string& option) { return names(message, option); });
  }

  Choices choices_{number_from("CLPV_RANDOM_SEED", 1)};
  TemporaryFolder folder_;
  std::vector<std::string> scenes_;
  std::map<int, int> codes_;
};

// With the kernels of other tests.
TEST_F(RandomOptions, GiveAnImageOrAReason) {
  expect_images_or_reasons(OptionValues{
      {"basis", "sh2"}, {"grid", "16"}, {"directions", "24"}, {"coarser-directions", "24"}});
}

struct LongRandomOptions : RandomOptions {};

// CLPV_RANDOM_KERNELS, CLPV_RANDOM_NUMBERS and CLPV_RANDOM_SEED make other and longer runs.
TEST_F(LongRandomOptions, GiveAnImageOrAReason) {
  expect_images_or_reasons(number_from("CLPV_RANDOM_KERNELS", kLongKernels));
}

}  // namespace clpv::random_options_test
