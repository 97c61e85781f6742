// SPDX-License-Identifier: MIT
// clpv compare: error metrics of an image against a ground truth, or changes between two reports.
#include "image/compare.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/drawing.hpp"
#include "cli/options.hpp"
#include "image/image_io.hpp"
#include "image/tone_map.hpp"
#include "support/error.hpp"
#include "support/json_schema.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

struct CompareOptions {
  std::string a, b, layer, output;
  float amplify = 15;
  std::optional<float> exposure;
  double fail_above = 0;  ///< 0: not given
};

/// Returns the file and the layer in "FILE:LAYER", or the layer `usual` of "FILE". A file may have
/// a colon in its name.
std::pair<std::string, std::string> file_and_layer(const std::string& text,
                                                   const std::string& usual) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || std::filesystem::exists(text)) return {text, usual};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

void check_output(const CompareOptions& options) {
  if (options.output.empty()) return;
  require_extension("--output", options.output, {".png", ".exr"});
  check_outputs({{"--output", options.output}}, {{"A", file_and_layer(options.a, "").first},
                                                 {"B", file_and_layer(options.b, "").first}});
}

/// Writes both images and their absolute difference side by side, with a scale. The exposure is
/// the ground truth's automatic one, unless it is given.
void write_sheet(const CompareOptions& options, const Drawing& drawing, const Image& a,
                 const Image& b, const Comparison& comparison) {
  const float exposure = options.exposure ? *options.exposure : automatic_exposure(b);
  const auto add = [&](const char* file, const Image& image) {
    drawing.add(file, image.pixels, image.width, image.height);
  };
  const auto add_shown = [&](const char* file, const Image& image) {
    Image black = image;
    std::ranges::fill(black.pixels, 0.0f);
    const Image colours = difference_image(image, black, 1);
    add(file, colours.encoding == Encoding::srgb ? colours
                                                 : display_image(colours, exposure, kDisplayCurve));
  };
  add_shown("a.npy", a);
  add_shown("b.npy", b);
  add("error.npy", difference_image(a, b, 1));
  drawing.add("compare.json", {{"a", printable(options.a)},
                               {"b", printable(options.b)},
                               {"nrmse", to_json(comparison)["nrmse_valid"]}});
  drawing.draw(options.output);
}

/// Warns if the files were rendered and traced with different bounces, exposures or tone curves.
void warn_of_inputs(const CompareOptions& options, const Image& a, const Image& b) {
  for (const char* name : {"bounces", "exposure", "tonemap"}) {
    const auto in_a = a.metadata.find(name), in_b = b.metadata.find(name);
    if (in_a == a.metadata.end() || in_b == b.metadata.end() || in_a->second == in_b->second)
      continue;
    log_warning("{} has {} {}, {} has {}: they differ by more than their error", options.a, name,
                in_a->second, options.b, in_b->second);
  }
}

Image read_layer(const std::string& text, const std::string& usual) {
  const auto [file, layer] = file_and_layer(text, usual);
  return read_image_layer(file, layer);
}

bool is_report(const std::string& file) {
  return std::filesystem::path(file).extension() == ".json";
}

void run(const CompareOptions& options) {
  if (is_report(options.a) && is_report(options.b))
    return compare_reports(options.a, options.b, options.fail_above);
  if (options.fail_above > 0)
    throw Error(ExitCode::usage,
                "--fail-above {}: found {} and {}, allowed with two reports (.json)",
                options.fail_above, options.a, options.b);
  check_output(options);
  std::optional<Drawing> sheet;
  if (std::filesystem::path(options.output).extension() == ".png")
    sheet.emplace("compare", "--output " + options.output);
  const Image a = read_layer(options.a, options.layer);
  const Image b = read_layer(options.b, options.layer);
  warn_of_inputs(options, a, b);
  const Comparison comparison = compare(a, options.a, b, options.b, options.exposure.value_or(0));
  if (sheet) write_sheet(options, *sheet, a, b, comparison);
  if (!sheet && !options.output.empty())
    write_exr(options.output, difference_image(a, b, options.amplify));
  print_json(to_json(comparison).dump(2) + "\n");
  require_valid_pixels(comparison, options.a, options.b);
}

}  // namespace

void add_compare(CLI::App& app, Shared&) {
  CLI::App* command = app.add_subcommand(
      "compare", "Errors of image A against ground truth B, or changes of report A against B");
  auto options = std::make_shared<CompareOptions>();
  command
      ->add_option("A", options->a,
                   "image: .exr, .png or .hdr; FILE.exr:LAYER names a layer or part. Or a report: "
                   "JSON of bench, quality or --stats")
      ->required();
  command
      ->add_option("B", options->b,
                   "ground truth of the same size, with a layer likewise. Or the earlier report of "
                   "the same command")
      ->required();
  add(*command, "-o,--output", "FILE", options->output,
      "A, B and their difference side by side with a scale (.png), or |A-B| x amplify (.exr)");
  add_number(*command, "--amplify", "X", options->amplify, "factor of the difference in an EXR",
             {0, 1e6});
  add_number(*command, "--exposure", "EV", options->exposure,
             "exposure of linear images [EV] (default: 0 for flip, automatic by B for a PNG)",
             {-30, 30});
  add(*command, "--layer", "NAME", options->layer,
      "layer to compare in both EXR files (default: the unnamed one)");
  add_number(*command, "--fail-above", "RATIO", options->fail_above,
             "exit with 5 if a value of the new report is more than RATIO times the earlier one, "
             "beyond the spread, or is missing, or if no row has both values",
             {1, 1e6})
      ->excludes("--output");
  command->footer(
      "Errors are over the colour channels (R, G and B; alpha is not compared), on the values as "
      "stored: linear in EXR\n"
      "and HDR, sRGB-encoded from 0 to 1 in PNG. psnr_db has its peak at 1 and is null without "
      "error; nrmse is rmse over\n"
      "the root mean square of B. nrmse_valid, best_gain, nrmse_best_gain, energy_ratio and flip "
      "are over the\n"
      "valid pixels: alpha above 0 in both, all where there is no alpha. flip (FLIP, Andersson et "
      "al. 2020) is the mean\n"
      "difference that an observer sees, from 0 to 1, of linear images after tone curve aces.\n"
      "Different sizes, pixels that only one file has, and values that are not finite exit with "
      "3,\nimages without a pixel that is valid in both, and reports without a row that has a "
      "value "
      "in both, with 5.");
  command->callback([options] { run(*options); });
}

}  // namespace clpv
