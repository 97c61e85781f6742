// SPDX-License-Identifier: MIT
// clpv check: compares every stage's kernels with double-precision CPU references on the chosen
// device.
#include "verify/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "support/error.hpp"
#include "support/helpers.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
#include "support/print.hpp"
#include "support/progress.hpp"
#include "verify/junit.hpp"
#include "verify/schedule.hpp"

namespace clpv {
namespace check_command {

using verify::CheckResult, verify::CheckResults, verify::Status;

constexpr double kUsualLimit = 600;  // [s]; the longest takes 20 s where all kernels are compiled

struct Options {
  verify::CheckChoice choice;
  std::string junit, claims, format;
  double limit = kUsualLimit;
  bool list = false;
};

std::size_t count(const CheckResults& results, Status status) {
  return static_cast<std::size_t>(std::ranges::count(results, status, &CheckResult::status));
}

/// "118 ok, 1 wrong, 0 failed, 4 unsupported"
std::string counts_of(const CheckResults& results) {
  std::string text;
  for (const Status status : values_of<Status>())
    text +=
        fmt::format("{}{} {}", text.empty() ? "" : ", ", count(results, status), name_of(status));
  return text;
}

/// Prints a stage: how many results are ok, the largest error relative to its tolerance, and each
/// other result.
void print(std::string_view stage, const CheckResults& results) {
  const std::size_t ok = count(results, Status::ok),
                    unsupported = count(results, Status::unsupported);
  print_data("{:<10} {:>4} of {:<4} {}", stage, ok, results.size(),
             ok + unsupported < results.size() ? "FAILED"
             : ok > 0                          ? "ok    "
                                               : "none  ");
  const auto share = [](const CheckResult& r) {
    return r.passed() ? r.deviation.worst / std::max(r.deviation.allowed, 1e-300) : -1;
  };
  if (ok > 0) {
    const CheckResult& worst = *std::ranges::max_element(results, {}, share);
    print_data("  worst {:.2e} of {:.0e} allowed ({})", worst.deviation.worst,
               worst.deviation.allowed, worst.variant);
  }
  print_data("\n");
  for (const CheckResult& r : results) {
    if (r.passed())
      log_debug("{} {}: {:.2e} of {:.0e}", stage, r.variant, r.deviation.worst,
                r.deviation.allowed);
    else if (r.status == Status::wrong)
      print_data("           {}: {:.3e} > {:.0e} at {}\n", r.variant, r.deviation.worst,
                 r.deviation.allowed, r.deviation.place);
    else
      print_data("           {}: {}: {}\n", r.variant, name_of(r.status), r.reason);
  }
  flush_data();
}

/// Collects the results of the cases and prints each stage when it is complete.
class Results {
 public:
  Results(const verify::Cases& cases, bool prints)
      : cases_(cases), prints_(prints), progress_("check", cases.size()) {}

  void add(const CheckResults& results) {
    all_.insert(all_.end(), results.begin(), results.end());
    const Stage stage = cases_[done_++].stage;
    progress_.advance();
    if (done_ < cases_.size() && cases_[done_].stage == stage) return;
    if (prints_)
      print(name_of(stage), {all_.begin() + static_cast<std::ptrdiff_t>(printed_), all_.end()});
    printed_ = all_.size();
  }
  const CheckResults& all() const { return all_; }

 private:
  const verify::Cases& cases_;
  bool prints_;
  Progress progress_;
  std::size_t done_ = 0, printed_ = 0;
  CheckResults all_;
};

/// Runs the cases in helpers. A single one runs in this process, which a debugger or an interpreter
/// watches, and so do all where there is no program to start, as in tests.
CheckResults results_of(const verify::Cases& cases, const Options& options, const Shared& shared,
                        const Device& device, bool prints) {
  Results results(cases, prints);
  const auto add = [&](const CheckResults& found) { results.add(found); };
  if (cases.size() < 2 || !has_helper_program()) {
    Session session(device);
    verify::run_here(cases, session, add);
    return results.all();
  }
  std::vector<std::string> arguments = options.choice.arguments();
  if (!shared.device.empty()) arguments.push_back("--device=" + shared.device);
  arguments.push_back("--quiet");
  verify::run_in_helpers(cases, arguments, options.limit, add);
  return results.all();
}

nlohmann::json report_of(const CheckResults& results, const Device& device) {
  nlohmann::json counts, checks = nlohmann::json::array();
  for (const Status status : values_of<Status>())
    counts[std::string(name_of(status))] = count(results, status);
  for (const CheckResult& result : results) checks.push_back(verify::to_json(result));
  return {{"schema", 1},
          {"device", to_json(device)},
          {"passed", verify::passed(results)},
          {"counts", counts},
          {"checks", checks}};
}

void run(const Options& options, const Shared& shared) {
  check_outputs({{"--junit", options.junit}});
  const verify::Cases cases = options.choice.cases();
  if (options.list) {
    for (const verify::Case& c : cases) print_data("{:<10} {}\n", name_of(c.stage), c.name);
    return;
  }
  const Device device = choose_device(shared.device);
  if (!options.claims.empty()) {
    become_helper();
    Session session(device);
    return verify::help(cases, session, Claims(options.claims));
  }
  log_info("checking {} ({}), driver {}: {} comparisons", device.name, device.platform,
           device.driver, cases.size());
  const bool json = options.format == "json";
  const CheckResults results = results_of(cases, options, shared, device, !json);
  if (json)
    print_json(report_of(results, device).dump(2) + "\n");
  else
    print_data("{}\n", counts_of(results));
  if (!options.junit.empty()) write_file(options.junit, verify::junit(results, device.name));
  if (verify::passed(results)) return;
  throw Error(ExitCode::validation,
              "comparisons on {}: {}; allowed: none wrong or failed, at least one ok", device.name,
              counts_of(results));
}

}  // namespace check_command

void add_check(CLI::App& app, Shared& shared) {
  using namespace check_command;
  CLI::App* command = app.add_subcommand(
      "check", "Compare every stage's kernels with double-precision CPU references on this device");
  auto options = std::make_shared<check_command::Options>();
  add_choices(*command, "--stage", options->choice.stages, "stages to check (default: all)");
  CLI::Option* thorough =
      command->add_flag("--thorough", options->choice.thorough,
                        "all combinations of bases, formats, lobes, tables, transports, states and "
                        "directions; takes minutes. Without it, each path of a kernel once: one "
                        "basis of each kind, each layout and number format");
  const auto take_preset = [options](const std::string& name) {
    options->choice.preset = named<PresetName>("--preset", name);
  };
  command
      ->add_option_function<std::string>(
          "--preset", take_preset,
          "instead: injection, propagation and gathering with the options of this preset together")
      ->check(CLI::IsMember(names_of<PresetName>()))
      ->excludes(thorough);
  command
      ->add_option(
          "--match", options->choice.match,
          "only comparisons with this text in their name, such as a basis or layout; repeatable")
      ->type_name("TEXT");
  add_number(*command, "--limit", "SECONDS", options->limit,
             "time after which one of several comparisons has failed [s]",
             {1e-3, 1e6, "0.001..1e6 s"});
  command->add_flag("--list", options->list, "print the names of the comparisons and end");
  add(*command, "--claims", "DIR", options->claims, "folder shared with other helpers")->group("");
  add_format(*command, options->format);
  add(*command, "--junit", "FILE.xml", options->junit,
      "output file in JUnit format, one test case per comparison");
  command->footer(
      "A comparison is ok, wrong (beyond its tolerance), failed (the driver reported an error, "
      "crashed, or took too long)\n"
      "or unsupported (the device lacks a capability). Exit code 5 if one is wrong or failed, or "
      "none is ok.");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
