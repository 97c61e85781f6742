// SPDX-License-Identifier: MIT
// clpv quality: errors of many variants' frames against the path-traced ground truth, and their
// times.
//
//   scenes, --camera   ->  Subject: a scene, its cameras, their ground truths
//   (quality_subjects.hpp)
//   --vary             ->  Variant: values of the options that vary (quality/quality.hpp)
//   subject x variant  ->  Group: the options of one frame, used for all cameras of the subject
//   group x camera     ->  QualityCell: read from the cache, or rendered, compared and stored
//   cells              ->  means of a variant; table and JSON (quality/quality.hpp)
//
// Ranks take every N-th group, or every N-th cell where groups are fewer than ranks.
#include "quality/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/quality_subjects.hpp"
#include "cli/render_request.hpp"
#include "clpv/version.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
#include "support/progress.hpp"

namespace clpv {
namespace quality_command {

struct Options {
  QualitySubjects subjects;
  std::shared_ptr<QualityAddition> addition;  ///< null: none
  std::vector<std::string> varied;
  std::string output, cache, format;
  Show view = Show::indirect;
  int frames = 3;
  bool fresh = false;
  TracingOptions tracing{.bounces = "1", .values = {}};
  OptionValues given;

  /// The option that asks for cells of the addition; empty: none.
  std::string asked() const { return addition ? addition->asked() : ""; }

  /// True if the command line names a frame option, apart from the size.
  bool named() const {
    return std::ranges::any_of(given, [](const auto& option) {
      return option.first != "width" && option.first != "height";
    });
  }
};

/// All combinations of the values of --vary. Without it: the frame that the options name; without
/// any option: all bases and transports.
std::vector<Variant> variants_of(const Options& options) {
  std::vector<VariedOption> varied;
  for (const std::string& text : options.varied) {
    varied.push_back(parse_varied(text));
    if (varied.back().name == "width" || varied.back().name == "height") {
      throw Error(ExitCode::usage,
                  "--vary {}: all variants have one size; allowed: --width and --height", text);
    }
  }
  if (varied.empty() && !options.named() && options.asked().empty()) {
    varied.push_back({"basis", basis_names()});
    varied.push_back({"transport", names_of<TransportKind>()});
  }
  return combinations(varied);
}

/// Frames use the number of bounces of the ground truth, unless --vary sets it.
RenderOptions with(const Options& options, const Variant& variant, const SceneData& scene) {
  OptionValues given = options.given;
  given["bounces"] = options.tracing.bounces;
  for (const auto& [name, value] : variant) given[name] = value;
  return resolve_options(given, scene);
}

struct Group {
  const Subject& subject;
  const Variant& variant;
  RenderOptions options;
};

/// Groups in order of subject, then variant. Throws for incompatible options.
std::vector<Group> groups_of(const Options& options, const std::vector<Subject>& subjects,
                             const std::vector<Variant>& variants) {
  std::vector<Group> groups;
  for (const Subject& subject : subjects) {
    for (const Variant& variant : variants)
      groups.push_back({subject, variant, with(options, variant, subject.scene)});
  }
  return groups;
}

/// Measures the cell of that group and camera; creates the group's frame if it does not exist yet.
QualityCell rendered(Session& session, std::unique_ptr<Frame>& frame, const Group& group,
                     std::size_t camera, const Options& options) {
  const auto started = std::chrono::steady_clock::now();
  QualityCell cell;
  try {
    double setup_s = 0;
    if (!frame) {
      frame = std::make_unique<Frame>(session, group.subject.scene, group.options);
      setup_s = ms_since(started) / 1000;
    }
    cell = measure(session, *frame, group.subject.cameras[camera], group.subject.truths[camera],
                   options.view, options.frames);
    cell.setup_s = setup_s;
  } catch (const Error& error) {
    // An incompatible basis and transport, or an unsuitable grid, is a valid result.
    if (error.code() != ExitCode::usage && error.code() != ExitCode::run_time) throw;
    cell.rejected = error.what();
  }
  cell.measured_s = ms_since(started) / 1000 - cell.setup_s;
  cell.scene = group.subject.scene.name;
  cell.camera = group.subject.cameras[camera].name;
  return cell;
}

/// Returns all cells by group and camera at rank 0, and this rank's cells at other ranks.
std::vector<QualityCell> measure_all(Ranks& ranks, Session& session,
                                     const std::vector<Group>& groups, QualityStore& store,
                                     const Options& options) {
  const bool whole = groups.size() >= static_cast<std::size_t>(ranks.size());
  const auto each = [&](const auto& action) {
    std::size_t cell = 0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      std::unique_ptr<Frame> frame;
      for (std::size_t camera = 0; camera < groups[g].subject.cameras.size(); ++camera, ++cell)
        if (ranks.takes(whole ? g : cell)) action(frame, groups[g], camera, cell);
    }
  };
  std::size_t mine = 0;
  each([&](auto&...) { ++mine; });
  std::set<std::pair<std::string, std::string>> warned;  // scenes and cameras
  std::map<std::size_t, nlohmann::json> cells;           // cells of this rank, by number
  Progress progress("quality", mine);
  const auto add = [&](std::unique_ptr<Frame>& frame, const Group& group, std::size_t camera,
                       std::size_t number) {
    stop_if_interrupted();
    const std::string key =
        quality_key(group.subject.truths[camera], session.device(), group.options, options.view,
                    options.frames, ranks.processors());
    std::optional<QualityCell> cell;
    if (!options.fresh) cell = store.find(key);
    const bool kept = cell.has_value();
    if (!kept) {
      cell = rendered(session, frame, group, camera, options);
      if (cell->rejected.empty() && warned.insert({cell->scene, cell->camera}).second)
        warn_of_unreached(session, *frame, cell->camera);
    }
    cell->variant = group.variant;  // the spelling of the same options may differ
    if (!kept && cell->rejected.empty()) store.keep(key, *cell);  // a rejection may be temporary
    cell->cached = kept;
    cells[number] = to_json(*cell);
    kept ? progress.skip() : progress.advance();
  };
  try {
    each(add);
  } catch (const Interrupted&) {
    const bool resumes = store.writable() && !options.fresh;
    throw Interrupted(fmt::format("{} of {} cells are finished{}", cells.size(), mine,
                                  resumes ? "; the same command resumes" : ""));
  }
  for (const std::string& gathered : ranks.gather(nlohmann::json(cells).dump()))
    cells.merge(nlohmann::json::parse(gathered).get<std::map<std::size_t, nlohmann::json>>());
  std::vector<QualityCell> all;
  for (const auto& [number, cell] : cells) all.push_back(cell_from_json(cell));
  return all;
}

nlohmann::json document(const std::vector<QualityCell>& cells, const std::vector<Subject>& subjects,
                        const Session& session, const Options& options) {
  nlohmann::json json = {{"schema", 2},
                         {"time", options.subjects.time},
                         {"version", version()},
                         {"view", name_of(options.view)},
                         {"frames", options.frames},
                         {"device", to_json(session.device())},
                         {"given", options.given}};
  for (const Subject& subject : subjects) {
    for (std::size_t view = 0; view < subject.cameras.size(); ++view) {
      const GroundTruth& truth = subject.truths[view];
      json["ground_truths"].push_back({{"scene", subject.scene.name},
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

void run(const Options& options, Shared& shared) {
  Ranks& ranks = shared.ranks();
  const std::vector<Variant> variants = variants_of(options);
  const pathtracer::PathTracerOptions tracing = options.tracing.resolved();
  if (!options.asked().empty() && ranks.size() > 1)
    throw Error(ExitCode::usage, "{}: found {} ranks; allowed: one", options.asked(), ranks.size());
  if (!options.output.empty()) require_extension("--output", options.output, {".json"});
  std::vector<NamedFile> outputs{{"--output", options.output}};
  check_outputs(outputs);
  const std::filesystem::path folder = quality_cache(options.cache);
  QualityStore store(folder / "cells");
  Session session(ranks.device(shared.device));
  std::vector<Subject> subjects = load_subjects(options.subjects);
  const std::vector<Group> groups = groups_of(options, subjects, variants);
  if (!options.asked().empty())
    std::ranges::move(options.addition->outputs(subjects), std::back_inserter(outputs));
  check_outputs(outputs);
  const auto frame = [&](const SceneData& scene) { return with(options, {}, scene); };
  trace_truths(subjects, frame, tracing, folder / "references", ranks);
  std::vector<QualityCell> cells = measure_all(ranks, session, groups, store, options);
  if (!ranks.is_root()) return;
  if (!options.asked().empty()) {
    std::ranges::move(options.addition->measure(session, subjects, frame, tracing.bounces,
                                                options.view, options.frames),
                      std::back_inserter(cells));
  }
  const std::string json = document(cells, subjects, session, options).dump(2) + "\n";
  if (!options.output.empty()) write_file(options.output, json);
  if (options.format == "json")
    print_json(json);
  else
    print_text(quality_table(cells));
}

void add_options(CLI::App& command, Options& options) {
  command
      .add_option("SCENE", options.subjects.scenes, "scene files (.json) or models (.gltf, .glb)")
      ->required();
  add_subject_options(command, options.subjects);
  add(command, "--vary", "OPTION=a,b,c", options.varied,
      "render option and its values, repeatable; each combination is a variant. Without --vary: "
      "the frame\n"
      "that the other options name, or all bases and transports if they name none");
  if (options.addition) options.addition->add_options(command);
  add_choice(command, "--view", options.view, "view to compare");
  add_number(
      command, "--frames", "N", options.frames,
      "number of timed frames per cell, after a warm-up frame; the results have their medians",
      {1, 1000});
  add_tracing_options(command, options.tracing);
  add(command, "--cache", "DIR", options.cache,
      "folder for cached ground truths and cells (default: $XDG_CACHE_HOME/clpv/quality)");
  command.add_flag("--fresh", options.fresh,
                   "new measurement of all cells, against cached ground truths");
  add_format(command, options.format);
  add(command, "-o,--output", "FILE.json", options.output, "output file for the results");
  add_frame_options(command, options.given);
  for (const auto& [name, size] : {std::pair{"width", "240"}, {"height", "135"}}) {
    options.given[name] = size;  // ground truths of a frame's default size take hours
    command.get_option(fmt::format("--{}", name))->default_str(size);
  }
}

}  // namespace quality_command

void add_quality(CLI::App& app, Shared& shared) {
  using namespace quality_command;
  CLI::App* command =
      app.add_subcommand("quality", "Errors against path tracing, and times, of many variants");
  auto options = std::make_shared<quality_command::Options>();
  options->addition = shared.additions.quality;
  add_options(*command, *options);
  command->footer(
      "nrmse: root mean square error over the ground truth's, over the valid pixels; best gain: "
      "after the\n"
      "single factor that minimises it; energy: ratio of sums; FLIP: mean visible difference, 0 to "
      "1,\n"
      "at the scene's exposure (Andersson et al. 2020).\n"
      "An interrupted run resumes from its cached cells. Another build, device, driver setting, "
      "number\n"
      "of threads or kernel file invalidates them.\n"
      "mpirun -n N clpv quality ... distributes the cells over N ranks (docs/scale.md).");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
