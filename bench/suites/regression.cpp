// SPDX-License-Identifier: MIT
// Suite `regression`: every kind of kernel once, on small fixed inputs, with rows for the build
// time of its programs. For authors of OpenCL implementations.
#include "basis/basis.hpp"
#include "bench/suites.hpp"
#include "support/named_enum.hpp"

namespace clpv::bench {
namespace {

// Small enough for an interpreter, large enough to exceed launch time.
constexpr int kCells = 16, kTexels = 64, kWidth = 160, kHeight = 90;

/// Row build/...: time from the programs' source text to the end of their first launch.
std::vector<Row> build_row(const Row& timed) {
  Row row;
  row.suite = timed.suite;
  row.stage = "build";
  row.name = "build/" + timed.name;
  row.coefficients = timed.coefficients;
  row.problem = timed.problem;
  row.from_events = false;
  row.samples_ms = {timed.build_ms + timed.first_launch_ms};
  row.times = statistics_of(row.samples_ms);
  row.wall_ms = row.times.median;
  row.build_ms = timed.build_ms;
  row.first_launch_ms = timed.first_launch_ms;
  return {row};
}

/// Adds a row of the build time to a case.
Case with_build(Case source) {
  source.make = [make = std::move(source.make)] {
    Job job = make();
    job.more_rows = build_row;
    return job;
  };
  return source;
}

SuiteOptions small(SuiteOptions options) {
  options.settings.grid = kCells;
  options.settings.rsm_size = kTexels;
  options.settings.width = kWidth, options.settings.height = kHeight;
  return options;
}

std::vector<Case> stages_of(const std::shared_ptr<Bench>& bench, const SuiteOptions& options,
                            const std::string& basis) {
  std::vector<Case> cases;
  const Problem usual = basis_problem(options, basis);
  for (const StageJob& job : kStageJobs)
    cases.push_back(with_build(stage_case(*bench, "regression", job, usual)));
  Problem with_occlusion = usual;
  with_occlusion.options.blockers = Blockers::seen;
  for (const StageJob& job : {kPropagate, kSweep})
    cases.push_back(with_build(stage_case(*bench, "regression", job, with_occlusion)));
  Problem in_half = usual;
  in_half.options.storage = Storage::float16;
  for (const StageJob& job : {kPropagate, kSweep})
    cases.push_back(with_build(stage_case(*bench, "regression", job, in_half)));
  return cases;
}

std::vector<Case> layouts_of(const std::shared_ptr<Bench>& bench, const SuiteOptions& options) {
  std::vector<Case> cases;
  for (const Layout layout : values_of<Layout>()) {
    if (layout == Layout::soa) continue;  // part of stages_of()
    Problem problem = basis_problem(options, "sh2");
    problem.options.layout = layout;
    cases.push_back(with_build(stage_case(*bench, "regression", kPropagate, problem)));
  }
  return cases;
}

}  // namespace

Suite regression_suite() {
  return {
      "regression",
      "every kind of kernel on small fixed inputs, and build times; for authors of OpenCL drivers",
      [](Session& session, const SuiteOptions& suite_options) {
        const SuiteOptions options = small(suite_options);
        const auto bench = make_bench(session, options, options.settings);
        const auto names = options.bases.empty() ? std::vector<std::string>{"sh2", "srbf8v2", "sh3"}
                                                 : options.bases;
        std::vector<Group> groups =
            groups_by_basis(names, [bench, options](const std::string& basis) {
              return stages_of(bench, options, basis);
            });
        groups.push_back({[bench, options] { return layouts_of(bench, options); }});
        return groups;
      },
      {}};
}

}  // namespace clpv::bench
