// clpv report: one page with images beside the truth, errors against costs, and benchmarks.
#include "report/report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "commands/frame_options.hpp"
#include "commands/quality_subjects.hpp"
#include "commands/tracing_options.hpp"
#include "image/tone_map.hpp"
#include "pipeline/frame.hpp"
#include "scene/input.hpp"
#include "support/error.hpp"
#include "support/output_file.hpp"
#include "support/progress.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestDocument = std::uintmax_t{64}
                                            << 20;  // bytes of JSON; a full matrix takes 2 MB

struct Options {
  std::string folder, cache;
  QualitySubjects subjects;
  std::vector<std::string> quality, benchmarks;
  std::string width = "240", height = "135";
  TracingOptions tracing;
};

/// The ways to render that a page shows, the one that matters last.
struct Way {
  const char* title;
  GivenOptions given;
};
const std::vector<Way>& ways() {
  static const std::vector<Way> all{{"published scheme (sh2)", {{"preset", "paper"}, {"basis", "sh2"}}},
                                    {"the paper (srbf8v2)", {{"preset", "paper"}}},
                                    {"clpv", {{"preset", "best"}}}};
  return all;
}

std::string as_arguments(const GivenOptions& given) {
  std::string text = "SCENE --view indirect";
  for (const auto& [name, value] : given) text += fmt::format(" --{} {}", name, value);
  return text;
}

nlohmann::json read_document(const std::string& path, const char* wanted) {
  const Bytes bytes = read_file(path, kLargestDocument, path);
  const nlohmann::json document =
      parse_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path);
  if (!document.is_object() || !document.contains(wanted)) {
    throw Error(ExitCode::bad_input, "{}: no '{}' in it; allowed: a file of clpv {} as JSON", path, wanted,
                std::string(wanted) == "variants" ? "quality" : "bench");
  }
  return document;
}

GivenOptions sized(const Options& options, GivenOptions given) {
  given["width"] = options.width;
  given["height"] = options.height;
  return given;
}

/// Indirect light alone is dark at the exposure of a whole image: brings its mean luminance to a fifth of white [EV].
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

report::Shot shot(Session& session, const Subject& subject, const Camera& camera, const Options& options,
                  const Way& way) {
  const RenderOptions resolved = resolve_options(sized(options, way.given), subject.scene);
  Frame frame(session, subject.scene, resolved);
  frame.render(camera);
  report::Shot shot{way.title, as_arguments(way.given),
                    make_image(resolved.width, resolved.height, {"R", "G", "B", "A"})};
  shot.image.pixels = frame.read(Show::indirect);
  return shot;
}

void add_views(std::vector<report::View>& views, Session& session, const Options& options, Subject& subject,
               const fs::path& references) {
  const RenderOptions size = resolve_options(sized(options, {}), subject.scene);
  trace_truths(subject, size.width, size.height, options.tracing.resolved(), references);
  Progress progress("report", subject.cameras.size() * ways().size());
  for (std::size_t view = 0; view < subject.cameras.size(); ++view) {
    const Camera& camera = subject.cameras[view];
    const reference::Reference& truth = subject.truths[view];
    report::View& shown = views.emplace_back();
    shown.scene = subject.scene.name;
    shown.camera = camera.name;
    shown.truth = extract_layer(truth.image, "indirect", truth.file.string());
    shown.exposure = exposure_of(shown.truth);
    for (const Way& way : ways()) {
      shown.shots.push_back(shot(session, subject, camera, options, way));
      progress.advance();
    }
  }
}

void run(const Options& options, const Shared& shared) {
  check_models(options.subjects);
  std::error_code failed;
  fs::create_directories(options.folder, failed);
  if (failed) throw Error(ExitCode::run_time, "{}: {}", options.folder, failed.message());
  const fs::path output = fs::path(options.folder) / "index.html";
  check_writable(output);

  report::Contents contents;
  for (const std::string& path : options.quality) contents.quality.push_back(read_document(path, "variants"));
  for (const std::string& path : options.benchmarks)
    contents.benchmarks.push_back(read_document(path, "benchmarks"));
  Session session(choose_device(shared.device), ProgramCache::of_user());
  std::vector<Subject> subjects = load_subjects(options.subjects);
  for (Subject& subject : subjects)
    add_views(contents.views, session, options, subject, quality_cache(options.cache) / "references");
  session.store_programs();
  const RenderOptions best;
  contents.marked = {"paper", "best", fmt::format("{} {}", best.basis, name_of(best.transport))};
  contents.subtitle =
      fmt::format("clpv {}, {} ({}), driver {}; views of {} x {} pixels", CLPV_VERSION, session.device().name,
                  session.device().platform, session.device().driver, options.width, options.height);
  write_file(output, report::page(contents));
  fmt::print("{}\n", output.string());
}

}  // namespace

void add_report(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand(
      "report", "One HTML page: images beside the truth, errors against costs, benchmarks");
  auto options = std::make_shared<Options>();
  command->add_option("DIR", options->folder, "where index.html is written")->required();
  command->add_option("SCENE", options->subjects.scenes,
                      "scene files whose views are shown beside path tracing");
  command
      ->add_option("--model", options->subjects.models,
                   "replaces a scene file's model; several scenes: STEM=PATH, repeatable")
      ->type_name("[STEM=]PATH");
  command->add_option("--camera", options->subjects.cameras, "by name, repeatable (default: all)")
      ->type_name("NAME");
  command->add_option("--quality", options->quality, "figures made by clpv quality --json, repeatable")
      ->type_name("FILE.json");
  command
      ->add_option("--bench", options->benchmarks,
                   "figures made by clpv bench table1 or layouts --format json, repeatable")
      ->type_name("FILE.json");
  command->add_option("--width", options->width, "of views and references [pixels]")->capture_default_str();
  command->add_option("--height", options->height, "of views and references [pixels]")->capture_default_str();
  add_tracing_options(*command, options->tracing);
  command->add_option("--cache", options->cache, "where references are kept (default: the user's cache)")
      ->type_name("DIR");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
