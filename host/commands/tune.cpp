// clpv tune: which launch shapes and which layout propagate fastest here, kept for render and bench.
#include "bench/tune.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "basis/basis.hpp"
#include "commands/commands.hpp"
#include "support/error.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

struct Options {
  bench::TuneOptions tune;
  std::string occlusion = "on";
  bool json = false;
};

void print(const std::vector<bench::Tuned>& tuned) {
  fmt::print("{:<10} {:<16} {:<13} {:<8} {:>6} {:>9} {:>10} {:>10} {:>6}\n", "basis", "transport", "state",
             "layout", "lanes", "local", "usual ms", "best ms", "gain");
  for (const bench::Tuned& t : tuned) {
    fmt::print("{:<10} {:<16} {:<13} {:<8} {:>6} {:>9} {:>10.3f} {:>10.3f} {:>5.2f}x\n", t.subject.basis,
               t.subject.transport, t.subject.state,
               t.subject.layout.empty() ? "> " + t.best.layout : t.subject.layout, t.best.lanes,
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
                    {"transport", t.subject.transport},
                    {"state", t.subject.state},
                    {"grid", t.subject.grid},
                    {"storage", t.subject.storage},
                    {"chosen", t.subject.layout.empty()},
                    {"layout", t.best.layout},
                    {"lanes", t.best.lanes},
                    {"local", t.best.local},
                    {"usual_ms", t.usual_ms},
                    {"best_ms", t.best_ms}});
  }
  fmt::print("{}\n", nlohmann::json{{"schema", 1}, {"tuned", list}}.dump(2));
}

void run(Options options, const Shared& shared) {
  options.tune.occlusion = options.occlusion == "on";
  for (const std::string& basis : options.tune.suite.bases) {
    const auto made = make_basis(basis);
    const Transport transport = make_transport(options.tune.render.transport, *made);
    if (options.tune.render.state == "fluxes" && !std::holds_alternative<FaceTransport>(transport.scheme))
      throw Error(ExitCode::usage, "--state fluxes: transport '{}' has no faces; allowed: coefficients",
                  transport.name);
  }
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
  options->tune.suite.bases = {options->tune.render.basis};
  command->add_option("--basis", options->tune.suite.bases, "bases, between commas")
      ->delimiter(',')
      ->capture_default_str()
      ->type_name("NAME");
  command->add_option("--transport", options->tune.render.transport, "how light moves")
      ->capture_default_str()
      ->check(CLI::IsMember(transport_names()));
  command->add_option("--state", options->tune.render.state, "what travels")
      ->capture_default_str()
      ->check(CLI::IsMember({"coefficients", "fluxes"}));
  command->add_option("--storage", options->tune.render.storage, "of volumes")
      ->capture_default_str()
      ->check(CLI::IsMember(storage_names()));
  command
      ->add_option("--layout", options->tune.layouts, "layouts to choose from, between commas; default: all")
      ->delimiter(',')
      ->check(CLI::IsMember(layout_names()));
  command->add_option("--occlusion", options->occlusion, "whether something blocks in what is timed")
      ->capture_default_str()
      ->check(CLI::IsMember({"on", "off"}));
  command->add_option("--grid", options->tune.suite.settings.grid, "cells along each axis")
      ->capture_default_str()
      ->check(CLI::Range(1, 512));
  command->add_option("--repetitions", options->tune.repetitions, "how often each shape is timed")
      ->capture_default_str()
      ->check(CLI::Range(1, bench::kMostRepetitions));
  command->add_flag("--json", options->json, "JSON on stdout");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
