// SPDX-License-Identifier: MIT
// clpv quality: how far the frames of many variants are from the path-traced truth, and what they cost.
#include "evaluate/quality.hpp"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "commands/frame_options.hpp"
#include "commands/quality_subjects.hpp"
#include "commands/time_option.hpp"
#include "commands/tracing_options.hpp"
#include "evaluate/quality_report.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"
#include "support/named_enum.hpp"
#include "support/output_file.hpp"
#include "support/progress.hpp"

namespace clpv {
namespace {

struct Options {
  QualitySubjects subjects;
  std::vector<std::string> varied;
  std::string view = "indirect", cache, json, csv, format = "table";
  int frames = 3;
  bool fresh = false;
  TracingOptions tracing;
  GivenOptions given;
};

/// All combinations: what --vary says; without a word about bases, transports or presets, which have both, all of them.
std::vector<Variant> variants(const Options& options) {
  std::vector<VariedOption> varied;
  for (const std::string& text : options.varied) {
    varied.push_back(parse_varied(text));
    if (varied.back().name == "width" || varied.back().name == "height") {
      throw Error(ExitCode::usage, "--vary {}: a reference has one size; fix it by --width and --height",
                  text);
    }
  }
  const auto mentioned = [&](const char* name) {
    return options.given.contains(name) || std::ranges::count(varied, name, &VariedOption::name) > 0;
  };
  const bool preset = mentioned("preset");
  if (!preset && !mentioned("transport"))
    varied.insert(varied.begin(), {"transport", names_of<TransportKind>()});
  if (!preset && !mentioned("basis") && !mentioned("centres"))
    varied.insert(varied.begin(), {"basis", basis_names()});
  return combinations(varied);
}

/// Frames have as many bounces as their truth, unless --vary says how many.
RenderOptions with(const Options& options, const Variant& variant, const Scene& scene) {
  GivenOptions given = options.given;
  given["bounces"] = options.tracing.bounces;
  for (const auto& [name, value] : variant) given[name] = value;
  return resolve_options(given, scene);
}

/// Measures the cells of one variant and scene, the frame made when the first of them is not kept already.
class VariantRun {
 public:
  VariantRun(Session& session, const Options& options, const QualityStore& store, const Subject& subject,
             const Variant& variant)
      : session_(session),
        options_(options),
        store_(store),
        subject_(subject),
        variant_(variant),
        frame_options_(with(options, variant, subject.scene)),
        show_(named<Show>("--view", options.view)) {}

  QualityCell cell(std::size_t view) {
    const reference::Reference& truth = subject_.truths[view];
    const std::string key = quality_key(truth, session_.device(), frame_options_, show_, options_.frames);
    if (auto kept = options_.fresh ? std::nullopt : store_.find(key)) {
      kept->variant = variant_;  // the same options may have been written otherwise
      return *kept;
    }
    QualityCell cell = rendered(view, truth);
    cell.scene = subject_.scene.name;
    cell.camera = subject_.cameras[view].name;
    cell.variant = variant_;
    if (cell.refused.empty()) store_.keep(key, cell);  // what was refused may be a matter of the moment
    return cell;
  }

 private:
  QualityCell rendered(std::size_t view, const reference::Reference& truth) {
    try {
      if (!frame_) frame_ = std::make_unique<Frame>(session_, subject_.scene, frame_options_);
      return measure(session_, *frame_, subject_.cameras[view], truth, show_, options_.frames);
    } catch (const Error& error) {
      // A basis that a transport cannot carry, a grid that does not fit: a result like any other.
      if (error.code() != ExitCode::usage && error.code() != ExitCode::run_time) throw;
      QualityCell cell;
      cell.refused = error.what();
      return cell;
    }
  }

  Session& session_;
  const Options& options_;
  const QualityStore& store_;
  const Subject& subject_;
  const Variant& variant_;
  RenderOptions frame_options_;
  Show show_;
  std::unique_ptr<Frame> frame_;
};

std::vector<QualityCell> measure_all(Session& session, const Options& options, const QualityStore& store,
                                     const std::vector<Subject>& subjects, const std::vector<Variant>& all) {
  std::size_t views = 0;
  for (const Subject& subject : subjects) views += subject.cameras.size();
  Progress progress("quality", views * all.size());
  std::vector<QualityCell> cells;
  for (const Subject& subject : subjects) {
    for (const Variant& variant : all) {
      VariantRun run(session, options, store, subject, variant);
      for (std::size_t view = 0; view < subject.cameras.size(); ++view) {
        stop_if_interrupted(fmt::format("{} of {} cells are kept; the same command goes on", cells.size(),
                                        views * all.size()));
        cells.push_back(run.cell(view));
        progress.advance();
      }
    }
  }
  return cells;
}

nlohmann::json document(const std::vector<QualityCell>& cells, const std::vector<Subject>& subjects,
                        const Session& session, const Options& options) {
  const Device& device = session.device();
  nlohmann::json json = {
      {"schema", 1},
      {"time", options.subjects.time},
      {"version", CLPV_VERSION},
      {"view", options.view},
      {"frames", options.frames},
      {"device", {{"platform", device.platform}, {"name", device.name}, {"driver", device.driver}}},
      {"given", options.given}};
  for (const Subject& subject : subjects) {
    for (std::size_t view = 0; view < subject.cameras.size(); ++view) {
      const reference::Reference& truth = subject.truths[view];
      json["references"].push_back({{"scene", subject.scene.name},
                                    {"camera", subject.cameras[view].name},
                                    {"file", truth.file.string()},
                                    {"spp", truth.samples},
                                    {"noise", truth.noise}});
    }
  }
  for (const QualityCell& cell : cells) json["cells"].push_back(to_json(cell));
  for (const QualitySummary& sum : summarise(cells)) json["variants"].push_back(to_json(sum));
  return json;
}

void run(const Options& options, const Shared& shared) {
  check_models(options.subjects);
  const std::vector<Variant> all = variants(options);
  named<Show>("--view", options.view);
  for (const std::string& output : {options.json, options.csv}) {
    if (!output.empty()) check_writable(output);
  }
  const std::filesystem::path folder = quality_cache(options.cache);
  const QualityStore store(folder / "cells");
  Session session(choose_device(shared.device));
  std::vector<Subject> subjects = load_subjects(options.subjects);
  for (Subject& subject : subjects) {
    const RenderOptions frame = with(options, {}, subject.scene);
    trace_truths(subject, frame.width, frame.height, options.tracing.resolved(), folder / "references");
  }
  const std::vector<QualityCell> cells = measure_all(session, options, store, subjects, all);
  const std::string json = document(cells, subjects, session, options).dump(2) + "\n";
  if (!options.json.empty()) write_file(options.json, json);
  if (!options.csv.empty()) write_file(options.csv, quality_csv(cells));
  fmt::print("{}", options.format == "json"  ? json
                   : options.format == "csv" ? quality_csv(cells)
                                             : quality_table(cells));
}

void add_options(CLI::App& command, Options& options) {
  command.add_option("SCENE", options.subjects.scenes, "scene files (.json), or bare .gltf or .glb")
      ->required();
  command
      .add_option("--model", options.subjects.models,
                  "replaces a scene file's model; several scenes: STEM=PATH, repeatable")
      ->type_name("[STEM=]PATH");
  command
      .add_option("--camera", options.subjects.cameras,
                  "by name, repeatable (default: all cameras of all scenes)")
      ->type_name("NAME");
  add_seconds(command, "--time", options.subjects.time, "the instant of scenes that move [s]");
  command
      .add_option("--vary", options.varied,
                  "a render option and its values, repeatable: every combination is a variant. Bases and "
                  "transports vary\n"
                  "over all there are, unless --preset, --basis, --centres or --transport fixes them or "
                  "--vary names them")
      ->type_name("OPTION=a,b,c");
  command.add_option("--view", options.view, fmt::format("{}", fmt::join(names_of<Show>(), "|")))
      ->type_name("VIEW")
      ->capture_default_str();
  command
      .add_option("--frames", options.frames,
                  "timed frames a cell, after one to warm up; their median counts")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  add_tracing_options(command, options.tracing);
  command
      .add_option("--cache", options.cache,
                  "where references and finished cells are kept (default: the user's cache)")
      ->type_name("DIR");
  command.add_flag("--fresh", options.fresh, "measures every cell anew; references are kept");
  command.add_option("--format", options.format, "of stdout")
      ->check(CLI::IsMember({"table", "json", "csv"}))
      ->capture_default_str();
  command.add_option("--json", options.json, "the same run as JSON")->type_name("FILE");
  command.add_option("--csv", options.csv, "the same run as CSV")->type_name("FILE");
  add_frame_options(command, options.given);
  for (const auto& [name, size] : {std::pair{"width", "240"}, {"height", "135"}}) {
    options.given[name] = size;  // references of a frame's usual size take hours
    command.get_option(fmt::format("--{}", name))->default_str(size);
  }
}

}  // namespace

void add_quality(CLI::App& app, Shared& shared) {
  CLI::App* command =
      app.add_subcommand("quality", "Errors against path tracing, and times, of many variants");
  auto options = std::make_shared<Options>();
  add_options(*command, *options);
  command->footer(
      "nrmse: root mean square error over the reference's root mean square, over the valid pixels; best "
      "gain: after the\n"
      "single factor that makes it least; energy: sum over sum; perceptual: share of pixels that fail Yee's "
      "test (1999).\n"
      "A run that was stopped goes on where it was. Cells of another build, device or kernel text are "
      "measured anew.");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
