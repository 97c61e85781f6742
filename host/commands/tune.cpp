// SPDX-License-Identifier: MIT
// clpv tune: which launch shapes and which layout propagate fastest here, kept for render and bench.
#include "bench/tune.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"
#include "pipeline/frame_volumes.hpp"
#include "support/error.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

struct Options {
  bench::TuneOptions tune;
  bool json = false;
};

std::string layout_of(const bench::Tuned& tuned) {
  return tuned.subject.layout ? std::string(name_of(*tuned.subject.layout))
                              : fmt::format("> {}", name_of(tuned.best.layout));
}

void print(const std::vector<bench::Tuned>& tuned) {
  fmt::print("{:<10} {:<16} {:<13} {:<8} {:>6} {:>9} {:>10} {:>10} {:>6}\n", "basis", "transport", "state",
             "layout", "lanes", "local", "usual ms", "best ms", "gain");
  for (const bench::Tuned& t : tuned) {
    fmt::print("{:<10} {:<16} {:<13} {:<8} {:>6} {:>9} {:>10.3f} {:>10.3f} {:>5.2f}x\n", t.subject.basis,
               name_of(t.subject.transport), name_of(t.subject.state), layout_of(t), t.best.lanes,
               fmt::format("{}x{}", t.best.local[0], t.best.local[1]), t.usual_ms, t.best_ms,
               t.usual_ms / t.best_ms);
  }
  fmt::print(
      "\n>: the fastest layout, which render takes unless told otherwise; held against soa as it is without "
      "tuning\n");
}

void print_json(const std::vector<bench::Tuned>& tuned) {
  nlohmann::json list = nlohmann::json::array();
  for (const bench::Tuned& t : tuned) {
    list.push_back({{"basis", t.subject.basis},
                    {"transport", name_of(t.subject.transport)},
                    {"state", name_of(t.subject.state)},
                    {"grid", t.subject.grid},
                    {"storage", name_of(t.subject.storage)},
                    {"chosen", !t.subject.layout},
                    {"layout", name_of(t.best.layout)},
                    {"lanes", t.best.lanes},
                    {"local", t.best.local},
                    {"usual_ms", t.usual_ms},
                    {"best_ms", t.best_ms}});
  }
  fmt::print("{}\n", nlohmann::json{{"schema", 1}, {"tuned", list}}.dump(2));
}

void run(const Options& options, const Shared& shared) {
  const RenderOptions& settings = options.tune.suite.settings;
  if (settings.transport == TransportKind::sweep)
    throw Error(ExitCode::usage, "--transport sweep: it takes no steps to tune; allowed: all others");
  require_faces(settings);
  const auto cache = TuningCache::of_user();
  if (!cache) throw Error(ExitCode::run_time, "nowhere to keep it: neither XDG_CACHE_HOME nor HOME is set");
  Session session(choose_device(shared.device), ProgramCache::of_user());
  spdlog::info("tuning for {} ({}), driver {}", session.device().name, session.device().platform,
               session.device().driver);
  const std::vector<bench::Tuned> tuned = bench::tune(session, options.tune);
  for (const bench::Tuned& t : tuned) cache->store(session.device(), t.subject, t.best);
  if (options.json) {
    print_json(tuned);
  } else {
    print(tuned);
  }
  session.store_programs();
}

}  // namespace

void add_tune(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand(
      "tune",
      "Find the fastest launch shapes and layout for propagation here; render and bench then use them");
  auto options = std::make_shared<Options>();
  command->add_option("--basis", options->tune.suite.bases, "bases, between commas")
      ->delimiter(',')
      ->capture_default_str()
      ->type_name("NAME");
  add_some_frame_options(*command, options->tune.suite.settings,
                         {"transport", "state", "storage", "occlusion", "grid"});
  add_choices(*command, "--layout", options->tune.layouts,
              "layouts to choose from, between commas; default: all");
  command->add_option("--repetitions", options->tune.repetitions, "how often each shape is timed")
      ->capture_default_str()
      ->check(CLI::Range(1, bench::kMostRepetitions));
  command->add_flag("--json", options->json, "JSON on stdout");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
