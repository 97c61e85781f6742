// SPDX-License-Identifier: MIT
// clpv bench: stage times on this device, in all variants.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "basis/basis.hpp"
#include "bench/row.hpp"
#include "bench/runner.hpp"
#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "scene/load.hpp"
#include "support/error.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"

namespace clpv {
namespace bench_command {

constexpr const char* kDefaultScene = "scenes/atrium.json";

struct Options {
  std::string suite, scene = kDefaultScene, model, filter, format, output, log;
  SceneChanges changes;
  bench::BenchOptions bench;
};

std::regex parse_filter(const std::string& text) {
  try {
    return std::regex(text);
  } catch (const std::regex_error& error) {
    throw Error(ExitCode::usage, "--filter '{}': {}; allowed: an ECMAScript regular expression",
                text, error.what());
  }
}

std::string as_text(const Options& options, std::string_view format, const bench::Suite& suite,
                    const Session& session, const std::vector<bench::Row>& rows) {
  const bench::SuiteOptions& timed = options.bench.suite;
  const std::string scene =
      fmt::format("{}, camera {}", timed.scene->name, timed.scene->camera(timed.camera).name);
  if (format == "json") return bench::report_json(session, scene, rows).dump(2) + "\n";
  if (format == "github-action") return bench::report_github_action(rows);
  return fmt::format("scene: {}\n", scene) +
         (suite.table ? suite.table(rows) : bench::report_table(rows));
}

/// Loads the scene of --scene into the options.
void load_suite_scene(Options& options) {
  MovingScene loaded(options.scene, options.model);
  options.changes.apply(loaded);
  const auto scene = std::make_shared<const SceneData>(std::move(loaded).take());
  options.bench.suite.scene = scene;
  if (scene->cascades) options.bench.suite.settings.cascades = *scene->cascades;
  if (scene->cascade_size) options.bench.suite.settings.cascade_size = *scene->cascade_size;
}

/// Throws Error(validation) if an output was wrong, or no row could run.
void require_right_results(const std::vector<bench::Row>& rows) {
  const auto wrong = std::ranges::count(rows, bench::Status::wrong, &bench::Row::status);
  if (wrong == 0 && std::ranges::count(rows, bench::Status::ok, &bench::Row::status) == 0) {
    throw Error(ExitCode::validation, "{} rows: none is ok; {}: {}: {}", rows.size(),
                rows.at(0).name, name_of(rows.at(0).status), rows.at(0).reason);
  }
  if (wrong == 0) return;
  const auto& first = *std::ranges::find(rows, bench::Status::wrong, &bench::Row::status);
  throw Error(ExitCode::validation, "{} of {} rows have wrong results; {}: {:.3g} > {:.0e} at {}",
              wrong, rows.size(), first.name, first.max_rel_error.value_or(0), first.tolerance,
              first.reason);
}

void run(Options options, const Shared& shared) {
  if (!options.filter.empty()) options.bench.filter = parse_filter(options.filter);
  for (const std::string& basis : options.bench.suite.bases) make_basis(basis);
  options.bench.log = options.log;
  if (!options.output.empty()) require_extension("--output", options.output, {".json"});
  const std::vector<NamedFile> outputs{{"--output", options.output}, {"--log", options.log}};
  check_outputs(outputs);
  const bench::Suite& suite =
      *std::ranges::find(bench::suites(), options.suite, &bench::Suite::name);
  load_suite_scene(options);
  check_outputs(outputs);
  const Device device = choose_device(shared.device);
  // Cached programs have no build time.
  Session session(device, ProgramCache::of_user(device));
  log_info("{} ({}), driver {}", session.device().name, session.device().platform,
           session.device().driver);
  const std::vector<bench::Row> rows = bench::run_suite(session, suite, options.bench);
  const auto text = [&](std::string_view format) {
    return as_text(options, format, suite, session, rows);
  };
  if (!options.output.empty()) write_file(options.output, text("json"));
  if (options.format == "table")
    print_text(text(options.format));
  else
    print_json(text(options.format));
  flush_data();
  session.programs().store();
  require_right_results(rows);
}

}  // namespace bench_command

void add_bench(CLI::App& app, Shared& shared) {
  using namespace bench_command;
  CLI::App* command =
      app.add_subcommand("bench", "Time stages and frames on this device, and check their outputs");
  auto options = std::make_shared<bench_command::Options>();
  std::string suites = "suite to run:";
  std::vector<std::string> names;
  for (const bench::Suite& suite : bench::suites()) {
    names.push_back(suite.name);
    suites += fmt::format("\n{}: {}", suite.name, suite.help);
  }
  command->add_option("SUITE", options->suite, suites)->required()->check(CLI::IsMember(names));
  add(*command, "--scene", "SCENE", options->scene,
      fmt::format("scene file or model (default: {})", kDefaultScene));
  add(*command, "--model", "PATH", options->model, "model file instead of the scene file's");
  CLI::Option* camera = add(*command, "--camera", "NAME", options->bench.suite.camera,
                            "name of the camera (default: the scene's first)");
  add_scene_changes(*command, options->changes, *camera);
  add(*command, "--basis", "NAME", options->bench.suite.bases,
      "comma-separated bases (default: those of the suite); table1 adds them to its own")
      ->delimiter(',');
  add(*command, "--filter", "REGEX", options->filter,
      "regular expression for the names of rows to run (default: all)");
  add_number(*command, "--repetitions", "N", options->bench.repetitions, "timed runs per row",
             {1, bench::kMaxRepetitions});
  add_format(*command, options->format, {"table", "json", "github-action"});
  add(*command, "--log", "FILE.jsonl", options->log,
      "log of row starts and ends, one JSON line each; after a crash its last line names the row");
  add(*command, "-o,--output", "FILE.json", options->output, "output file for the results, .json");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
