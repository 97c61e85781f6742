// SPDX-License-Identifier: MIT
// clpv quality: how far the frames of many variants are from the path-traced truth, and what they cost.
#include "evaluate/quality.hpp"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "clpv/version.hpp"
#include "commands/commands.hpp"
#include "commands/frame_options.hpp"
#include "commands/quality_cells.hpp"
#include "commands/quality_subjects.hpp"
#include "commands/time_option.hpp"
#include "commands/tracing_options.hpp"
#include "evaluate/quality_report.hpp"
#include "parallel/rank_device.hpp"
#include "support/error.hpp"
#include "support/named_enum.hpp"
#include "support/output_file.hpp"

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

/// What is measured, of subjects and variants that must outlive it.
QualityMatrix matrix(const Options& options, const std::vector<Subject>& subjects,
                     const std::vector<Variant>& all) {
  QualityMatrix matrix{subjects, all, {}, named<Show>("--view", options.view), options.frames, options.fresh};
  for (const Subject& subject : subjects) {
    std::vector<RenderOptions>& of_subject = matrix.options.emplace_back();
    for (const Variant& variant : all) of_subject.push_back(with(options, variant, subject.scene));
  }
  return matrix;
}

nlohmann::json document(const std::vector<QualityCell>& cells, const std::vector<Subject>& subjects,
                        const Session& session, const Options& options) {
  const Device& device = session.device();
  nlohmann::json json = {
      {"schema", 1},
      {"time", options.subjects.time},
      {"version", version()},
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

/// All that is there before anything is measured.
struct Prepared {
  std::vector<Variant> variants;
  std::filesystem::path folder;
  std::optional<QualityStore> store;
  std::unique_ptr<Session> session;
  std::vector<Subject> subjects;  ///< without truths
};

Prepared prepare(const Options& options, const Shared& shared, const Team& team) {
  check_models(options.subjects);
  Prepared made;
  made.variants = variants(options);
  named<Show>("--view", options.view);
  for (const std::string& output : {options.json, options.csv}) {
    if (!output.empty()) check_writable(output);
  }
  made.folder = quality_cache(options.cache);
  made.store.emplace(made.folder / "cells");
  made.session = std::make_unique<Session>(device_of_rank(team, shared.device));
  made.subjects = load_subjects(options.subjects);
  return made;
}

void tell(const std::vector<QualityCell>& cells, const Prepared& made, const Options& options) {
  const std::string json = document(cells, made.subjects, *made.session, options).dump(2) + "\n";
  if (!options.json.empty()) write_file(options.json, json);
  if (!options.csv.empty()) write_file(options.csv, quality_csv(cells));
  fmt::print("{}", options.format == "json"  ? json
                   : options.format == "csv" ? quality_csv(cells)
                                             : quality_table(cells));
}

void run(const Options& options, Shared& shared) {
  Team& team = shared.team();
  Prepared made;
  team.agree([&] { made = prepare(options, shared, team); });
  tell_devices(team, made.session->device());
  for (Subject& subject : made.subjects) {
    const RenderOptions frame = with(options, {}, subject.scene);
    trace_truths(subject, frame.width, frame.height, options.tracing.resolved(), made.folder / "references",
                 team);
  }
  std::optional<QualityMatrix> measured;
  team.agree([&] { measured.emplace(matrix(options, made.subjects, made.variants)); });
  const std::vector<QualityCell> cells = measure_all(team, *made.session, *measured, *made.store);
  if (team.leads()) tell(cells, made, options);
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
      "measured anew.\n"
      "mpirun -n N clpv quality ... shares the cells among N ranks (docs/scale.md).");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
