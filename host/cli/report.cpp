// SPDX-License-Identifier: MIT
// clpv report: HTML page with images and ground truth, errors over times, and benchmarks; uses
// python/clpv/draw.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "cli/commands.hpp"
#include "cli/drawing.hpp"
#include "cli/options.hpp"
#include "cli/quality_subjects.hpp"
#include "cli/render_request.hpp"
#include "clpv/version.hpp"
#include "image/compare.hpp"
#include "image/image_io.hpp"
#include "image/tone_map.hpp"
#include "options/render_options.hpp"
#include "pipeline/frame/frame.hpp"
#include "support/error.hpp"
#include "support/json_schema.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
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
  TracingOptions tracing{.bounces = "1", .values = {}};
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

std::string title_of(const std::string& folder) {
  return fs::weakly_canonical(folder).filename().string();
}

/// The image of another method for a view. Throws Error(bad_input) without channels R, G and B, and
/// as check_comparable() with an image of the page.
Image read_image_of_method(const fs::path& path, const Options& options) {
  Image image = read_image_layer(path, "");
  const std::array colours{"R", "G", "B"};
  if (image.channels.size() < colours.size() ||
      !std::equal(colours.begin(), colours.end(), image.channels.begin())) {
    throw Error(ExitCode::bad_input, "{}: channels {}; allowed: R, G, B and perhaps A",
                path.string(), fmt::join(image.channels, ", "));
  }
  check_comparable(image, path.string(), make_image(options.width, options.height, {"R", "G", "B"}),
                   "the page");
  return image;
}

/// A view of the page, with the names of its images' files and their errors.
struct PageView {
  std::string name;
  Image truth;
  float exposure = 0;
  nlohmann::json images;
};

/// Writes values of each pixel. Returns the name of the file.
std::string add_values(const Drawing& drawing, const PageView& view, const char* kind,
                       std::span<const float> values) {
  const std::string file = fmt::format("{}-{}-{}.npy", view.name, view.images.size(), kind);
  drawing.add(file, values, view.truth.width, view.truth.height);
  return file;
}

/// Adds an image with its errors. `source` names it in messages.
void add_compared(const Drawing& drawing, PageView& view, const std::string& title,
                  const Image& image, const std::string& source) {
  const nlohmann::json errors =
      to_json(compare(image, source, view.truth, "ground truth", view.exposure));
  const std::vector<double> map = flip_map(image, view.truth, view.exposure);
  view.images.push_back(
      {{"title", title},
       {"file", add_values(drawing, view, "image", image.pixels)},
       {"flip", add_values(drawing, view, "flip", std::vector<float>(map.begin(), map.end()))},
       {"errors",
        {{"nrmse", errors["nrmse_valid"]},
         {"nrmse_best_gain", errors["nrmse_best_gain"]},
         {"energy_ratio", errors["energy_ratio"]},
         {"flip", errors["flip"]}}}});
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

/// Adds what a variant renders of all cameras of a subject to their views.
void add_variant(Session& session, const Options& options, const Subject& subject,
                 const PageVariant& variant, const Drawing& drawing, std::vector<PageView>& views,
                 Progress& progress) {
  const auto resolved = options_for(variant, options, subject.scene);
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (resolved) {
      Frame frame(session, subject.scene, *resolved);
      frame.render(subject.cameras[i]);
      warn_of_unreached(session, frame,
                        fmt::format("{}, {}", subject.cameras[i].name, variant.title));
      add_compared(drawing, views[i], variant.title, view_image(frame, Show::indirect),
                   variant.title);
    }
    progress.advance();
  }
}

/// The views of a subject, with their ground truths.
std::vector<PageView> views_of(const Subject& subject, const Drawing& drawing) {
  std::vector<PageView> views;
  for (std::size_t i = 0; i < subject.cameras.size(); ++i) {
    const GroundTruth& traced = subject.truths[i];
    PageView view{view_file_name(subject.scene.name, subject.cameras[i].name),
                  extract_layer(traced.image, "indirect", traced.file.string()), 0,
                  nlohmann::json::array()};
    view.exposure = exposure_of(view.truth);
    view.images.push_back({{"title", "path tracing"},
                           {"file", add_values(drawing, view, "image", view.truth.pixels)}});
    views.push_back(std::move(view));
  }
  return views;
}

/// Adds the images of other methods.
void add_others(const Options& options, const Subject& subject, const Drawing& drawing,
                std::vector<PageView>& views) {
  for (const std::string& folder : options.images) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      const fs::path file = file_of(folder, subject, subject.cameras[i]);
      add_compared(drawing, views[i], title_of(folder), read_image_of_method(file, options),
                   file.string());
    }
  }
}

/// Throws Error(run_time) for a page that clpv did not write (python/clpv/draw/base.html).
void require_own_page(const fs::path& page) {
  if (!fs::is_regular_file(page)) return;
  std::ifstream file(page, std::ios::binary);
  std::string start(1000, ' ');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  if (start.find("<meta name=\"generator\" content=\"clpv\">") != std::string::npos) return;
  throw Error(ExitCode::run_time,
              "{}: found a file that clpv did not write; allowed: none, or a page", page.string());
}

/// Titles of all methods, in the order of their images.
nlohmann::json methods(const Options& options) {
  nlohmann::json all = nlohmann::json::array();
  for (const PageVariant& variant : page_variants(options)) {
    std::string arguments = "SCENE --view indirect";
    for (const auto& [name, value] : variant.given)
      arguments += fmt::format(" --{} {}", name, value);
    all.push_back({{"title", variant.title}, {"options", arguments}});
  }
  for (const std::string& folder : options.images)
    all.push_back({{"title", title_of(folder)}, {"options", nullptr}});
  return all;
}

/// Writes the images of all views. Returns the views as of report.json.
nlohmann::json add_views(Session& session, const Options& options, const Drawing& drawing) {
  nlohmann::json all = nlohmann::json::array();
  std::vector<Subject> subjects = load_subjects(options.subjects);
  require_distinct_names("report", subjects);
  for (const Subject& subject : subjects)  // before minutes of tracing
    for (const SceneCamera& camera : subject.cameras)
      for (const std::string& folder : options.images)
        read_image_of_method(file_of(folder, subject, camera), options);
  check_outputs({{"DIR", page_of(options), true}});
  const std::vector<PageVariant> variants = page_variants(options);
  const auto frame = [&](const SceneData& scene) {
    return resolve_options(sized(options, {}), scene);
  };
  trace_truths(subjects, frame, options.tracing.resolved(),
               quality_cache(options.cache) / "references");
  for (Subject& subject : subjects) {
    std::vector<PageView> views = views_of(subject, drawing);
    Progress progress("report", subject.cameras.size() * variants.size());
    for (const PageVariant& variant : variants)
      add_variant(session, options, subject, variant, drawing, views, progress);
    add_others(options, subject, drawing, views);
    for (PageView& view : views) {
      all.push_back({{"name", view.name},
                     {"width", view.truth.width},
                     {"height", view.truth.height},
                     {"exposure", view.exposure},
                     {"images", std::move(view.images)}});
    }
  }
  return all;
}

void run(const Options& options, const Shared& shared) {
  if (options.subjects.scenes.empty() && options.quality.empty() && options.benchmarks.empty())
    throw Error(ExitCode::usage, "report: nothing to show; allowed: scenes, --quality or --bench");
  const OutputFolder folder("DIR", options.folder);
  if (!options.images.empty() && options.subjects.scenes.empty())
    throw Error(ExitCode::usage, "--images: needs a scene");
  nlohmann::json report{{"quality", read_documents(options.quality, "variants", "quality")},
                        {"benchmarks", read_documents(options.benchmarks, "benchmarks", "bench")}};
  check_outputs({{"DIR", page_of(options), true}});
  require_own_page(page_of(options));
  const Drawing drawing("report", "clpv report");
  const Device device = choose_device(shared.device);
  Session session(device, ProgramCache::of_user(device));
  report["methods"] = report["views"] = nlohmann::json::array();
  if (!options.subjects.scenes.empty()) {
    report["views"] = add_views(session, options, drawing);
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
  drawing.draw(page_of(options));
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
