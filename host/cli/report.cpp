// SPDX-License-Identifier: MIT
// clpv report: HTML page with images and ground truth, errors over times, and benchmarks; uses
// python/clpv/draw.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.hpp"
#include "cli/drawing.hpp"
#include "cli/image_layer.hpp"
#include "cli/options.hpp"
#include "cli/quality_subjects.hpp"
#include "cli/render_request.hpp"
#include "cli/unreached.hpp"
#include "clpv/version.hpp"
#include "image/image_io.hpp"
#include "image/tone_map.hpp"
#include "options/validate.hpp"
#include "pipeline/frame/frame.hpp"
#include "support/error.hpp"
#include "support/json_schema.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
#include "support/print.hpp"
#include "support/progress.hpp"
#include "support/text.hpp"

namespace clpv {
namespace report_command {

namespace fs = std::filesystem;

struct Options {
  std::string folder, cache;
  QualitySubjects subjects;
  std::vector<std::string> quality, benchmarks, images;
  int width = 240, height = 135;
  TracingOptions tracing;
};

/// Render variants of the page. The most important comes last; only it has as many bounces as the
/// ground truth.
struct PageVariant {
  const char* title;
  OptionValues given;
};
std::vector<PageVariant> page_variants(const Options& options) {
  return {{"published scheme (sh2)", {{"preset", "paper"}, {"basis", "sh2"}}},
          {"published scheme (srbf8v2)", {{"preset", "paper"}}},
          {"clpv", {{"preset", "best"}, {"bounces", options.tracing.bounces}}}};
}

std::string as_arguments(const OptionValues& given) {
  std::string text = "SCENE --view indirect";
  for (const auto& [name, value] : given) text += fmt::format(" --{} {}", name, value);
  return text;
}

/// Input documents of the page, each with its file name for messages.
nlohmann::json read_documents(const std::vector<std::string>& paths, const char* wanted,
                              const char* command) {
  nlohmann::json all = nlohmann::json::array();
  for (const std::string& path : paths) {
    const nlohmann::json document = read_json(path);
    if (!document.is_object() || !document.contains(wanted)) {
      throw Error(ExitCode::bad_input, "{}: no '{}' in it; allowed: a file of clpv {} as JSON",
                  path, wanted, command);
    }
    all.push_back({{"file", path}, {"document", document}});
  }
  return all;
}

fs::path page_of(const Options& options) {
  return fs::path(options.folder) / "index.html";
}

OptionValues sized(const Options& options, OptionValues given) {
  given["width"] = std::to_string(options.width);
  given["height"] = std::to_string(options.height);
  return given;
}

/// Exposure [EV] that raises the mean luminance of indirect light, dark at the image's exposure, to
/// 20 % of white.
float exposure_of(const Image& truth) {
  double sum = 0, count = 0;
  for (int y = 0; y < truth.height; ++y) {
    for (int x = 0; x < truth.width; ++x) {
      sum += luminance({truth.at(x, y, 0), truth.at(x, y, 1), truth.at(x, y, 2)});
      count += truth.at(x, y, 3);
    }
  }
  constexpr double kMean = 0.2;
  return sum > 0 ? static_cast<float>(std::log2(kMean * count / sum)) : 0;
}

fs::path file_of(const std::string& folder, const Subject& subject, const SceneCamera& camera) {
  return fs::path(folder) / (view_file_name(subject.scene.name, camera.name) + ".exr");
}

/// The image of another method for a view. Throws Error(bad_input) without channels R, G and B.
Image read_image_of_method(const fs::path& path) {
  Image image = read_image_layer(path, "");
  const std::array colours{"R", "G", "B"};
  if (image.channels.size() < colours.size() ||
      !std::equal(colours.begin(), colours.end(), image.channels.begin())) {
    throw Error(ExitCode::bad_input, "{}: channels {}; allowed: R, G, B and perhaps A",
                path.string(), fmt::join(image.channels, ", "));
  }
  return image;
}

/// Writes an image of method `number` where the scorer finds it.
void add_image(const Drawing& drawing, std::size_t number, const std::string& view,
               const Image& image) {
  fs::create_directories(drawing.folder() / std::to_string(number));
  write_exr(drawing.folder() / std::to_string(number) / (view + ".exr"), image);
}

/// Options of a variant for a scene, or none, with a warning: the published scheme has no sky.
std::optional<RenderOptions> options_for(const PageVariant& variant, const Options& options,
                                         const SceneData& scene) {
  try {
    const RenderOptions resolved = resolve_options(sized(options, variant.given), scene);
    validate(resolved, scene);
    return resolved;
  } catch (const Error& error) {
    if (error.code() != ExitCode::usage || scene.sky == nullptr) throw;
    log_warning("{}: not on the page by {}: {}", scene.path, variant.title, error.what());
    return std::nullopt;
  }
}

/// Writes what a variant renders of all cameras of a subject.
void add_variant(Session& session, const Options& options, const Subject& subject,
                 std::size_t number, const Drawing& drawing, Progress& progress) {
  const PageVariant variant = page_variants(options)[number];
  const auto resolved = options_for(variant, options, subject.scene);
  for (const SceneCamera& camera : subject.cameras) {
    if (resolved) {
      Frame frame(session, subject.scene, *resolved);
      frame.render(camera);
      warn_of_unreached(session, frame, fmt::format("{}, {}", camera.name, variant.title));
      add_image(drawing, number, view_file_name(subject.scene.name, camera.name),
                view_image(frame, Show::indirect));
    }
    progress.advance();
  }
}

/// Writes truth and images of others of each view. Returns the views as of suite.json.
nlohmann::json add_truths(const Options& options, const Subject& subject, const Drawing& drawing) {
  nlohmann::json views = nlohmann::json::array();
  for (std::size_t i = 0; i < subject.cameras.size(); ++i) {
    const GroundTruth& traced = subject.truths[i];
    const std::string name = view_file_name(subject.scene.name, subject.cameras[i].name);
    const std::string file = fmt::format("truths/{}.exr", name);
    write_exr(drawing.folder() / file, traced.image);
    for (std::size_t k = 0; k < options.images.size(); ++k) {
      add_image(drawing, page_variants(options).size() + k, name,
                read_image_of_method(file_of(options.images[k], subject, subject.cameras[i])));
    }
    const Image truth = extract_layer(traced.image, "indirect", traced.file.string());
    views.push_back({{"name", name},
                     {"truth", file},
                     {"noise", traced.noise},
                     {"exposure", exposure_of(truth)}});
  }
  return views;
}

/// Titles of all methods, in the order of their folders.
nlohmann::json methods(const Options& options) {
  nlohmann::json all = nlohmann::json::array();
  for (const PageVariant& variant : page_variants(options))
    all.push_back({{"title", variant.title}, {"options", as_arguments(variant.given)}});
  for (const std::string& folder : options.images)
    all.push_back(
        {{"title", fs::weakly_canonical(folder).filename().string()}, {"options", nullptr}});
  return all;
}

/// Writes the suite of all views, and the images of all methods.
void add_views(Session& session, const Options& options, const Drawing& drawing) {
  nlohmann::json all = nlohmann::json::array();
  std::vector<Subject> subjects = load_subjects(options.subjects);
  require_distinct_names("report", subjects);
  for (const Subject& subject : subjects)  // before minutes of tracing
    for (const SceneCamera& camera : subject.cameras)
      for (const std::string& folder : options.images)
        read_image_of_method(file_of(folder, subject, camera));
  check_outputs({{"DIR", page_of(options)}});
  fs::create_directory(drawing.folder() / "truths");
  const std::size_t variants = page_variants(options).size();
  for (Subject& subject : subjects) {
    const RenderOptions size = resolve_options(sized(options, {}), subject.scene);
    trace_truths(subject, size.width, size.height, options.tracing.resolved(),
                 quality_cache(options.cache) / "references");
    for (nlohmann::json& view : add_truths(options, subject, drawing)) all.push_back(view);
    Progress progress("report", subject.cameras.size() * variants);
    for (std::size_t i = 0; i < variants; ++i)
      add_variant(session, options, subject, i, drawing, progress);
  }
  drawing.add("suite.json", {{"schema", 1}, {"hash", "report"}, {"views", all}});
}

void run(const Options& options, const Shared& shared) {
  if (options.subjects.scenes.empty() && options.quality.empty() && options.benchmarks.empty())
    throw Error(ExitCode::usage, "report: nothing to show; allowed: scenes, --quality or --bench");
  create_folder("DIR", options.folder);
  if (!options.images.empty() && options.subjects.scenes.empty())
    throw Error(ExitCode::usage, "--images: needs a scene");
  nlohmann::json report{{"quality", read_documents(options.quality, "variants", "quality")},
                        {"benchmarks", read_documents(options.benchmarks, "benchmarks", "bench")}};
  check_outputs({{"DIR", page_of(options)}});
  const Drawing drawing("report", "clpv report");
  const Device device = choose_device(shared.device);
  Session session(device, ProgramCache::of_user(device));
  report["methods"] = nlohmann::json::array();
  if (!options.subjects.scenes.empty()) {
    add_views(session, options, drawing);
    report["methods"] = methods(options);
  }
  session.programs().store();
  const RenderOptions best;
  report["marked"] = {{{"preset", "paper"}},
                      {{"preset", "best"}},
                      {{"basis", best.basis}, {"transport", name_of(best.transport)}}};
  report["subtitle"] = fmt::format("clpv {}, {} ({}), driver {}; views of {} x {} pixels",
                                   version(), session.device().name, session.device().platform,
                                   session.device().driver, options.width, options.height);
  drawing.add("report.json", report);
  drawing.draw(options.folder);
  print_data("{}\n", page_of(options).string());
}

}  // namespace report_command

void add_report(CLI::App& app, Shared& shared) {
  using namespace report_command;
  CLI::App* command = app.add_subcommand(
      "report", "Write an HTML page: images and ground truth, errors over times, benchmarks");
  auto options = std::make_shared<report_command::Options>();
  command->add_option("DIR", options->folder, "output folder for index.html")->required();
  command->add_option("SCENE", options->subjects.scenes,
                      "scene files to compare with path tracing");
  add_subject_options(*command, options->subjects);
  add(*command, "--quality", "FILE.json", options->quality,
      "results of clpv quality -o FILE.json, repeatable");
  add(*command, "--bench", "FILE.json", options->benchmarks,
      "results of clpv bench table1 or layouts -o FILE.json, repeatable");
  add(*command, "--images", "DIR", options->images,
      "images of another method: DIR/SCENE-CAMERA.exr of indirect light, repeatable");
  add_number(*command, "--width", "N", options->width, "width of the images [pixels]",
             {1, kMaxPixels});
  add_number(*command, "--height", "N", options->height, "height of the images [pixels]",
             {1, kMaxPixels});
  add_tracing_options(*command, options->tracing);
  add(*command, "--cache", "DIR", options->cache,
      "folder for cached ground truths (default: $XDG_CACHE_HOME/clpv/quality)");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
