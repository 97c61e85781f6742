// SPDX-License-Identifier: MIT
// clpv compare: error metrics of an image against a ground truth, or changes between two reports.
#include "image/compare.hpp"

#include <nlohmann/json.hpp>

#include "bench/compare_runs.hpp"
#include "cli/commands.hpp"
#include "cli/image_layer.hpp"
#include "cli/options.hpp"
#include "image/image_io.hpp"
#include "image/tone_map.hpp"
#include "support/error.hpp"
#include "support/json_schema.hpp"
#include "support/output_file.hpp"
#include "support/print.hpp"

namespace clpv {
namespace {

struct CompareOptions {
  std::string a, b, layer, output;
  float amplify = 15, exposure = 0;
  double fail_above = 0;  ///< 0: not given
};

bool is_png(const std::filesystem::path& path) {
  return path.extension() == ".png";
}

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

void write_difference(const std::string& output, const Image& difference) {
  if (!is_png(output)) {
    write_exr(output, difference);
  } else if (difference.encoding == Encoding::srgb) {
    write_png(output, difference);  // of display values, byte-identical to the paper's method
  } else {
    write_png(output, display_image(difference, 0, ToneMap::none));
  }
}

Image read_layer(const std::string& text, const std::string& usual) {
  const auto [file, layer] = file_and_layer(text, usual);
  return read_image_layer(file, layer);
}

bool is_report(const std::string& file) {
  return std::filesystem::path(file).extension() == ".json";
}

/// Compares reports of bench, quality or --stats.
void compare_reports(const CompareOptions& options) {
  const bench::ReportChanges changes =
      bench::compare_runs(read_json(options.b), read_json(options.a), options.b, options.a);
  print_text(bench::changes_table(changes));
  bench::require_ratios(changes, options.fail_above);
}

void run(const CompareOptions& options) {
  if (is_report(options.a) && is_report(options.b)) return compare_reports(options);
  if (options.fail_above > 0)
    throw Error(ExitCode::usage,
                "--fail-above {}: found {} and {}, allowed with two reports (.json)",
                options.fail_above, options.a, options.b);
  check_output(options);
  const Image a = read_layer(options.a, options.layer);
  const Image b = read_layer(options.b, options.layer);
  const Comparison comparison = compare(a, options.a, b, options.b, options.exposure);
  if (!options.output.empty())
    write_difference(options.output, difference_image(a, b, options.amplify));
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
      "difference image |A-B| x amplify, .png or .exr");
  add_number(*command, "--amplify", "X", options->amplify, "factor of the difference image",
             {0, 1e6});
  add_number(*command, "--exposure", "EV", options->exposure,
             "exposure of linear images for flip [EV]", {-30, 30})
      ->default_str("0");
  add(*command, "--layer", "NAME", options->layer,
      "layer to compare in both EXR files (default: the unnamed one)");
  add_fail_above(*command, options->fail_above)->excludes("--output");
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
