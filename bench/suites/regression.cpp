// SPDX-License-Identifier: MIT
// Suite `regression`: small and fixed, for who works on an OpenCL implementation: every kind of kernel once, and how long
// its programs took to build, as rows of their own.
#include "basis/basis.hpp"
#include "bench/suites.hpp"
#include "support/named_enum.hpp"

namespace clpv::bench {
namespace {

// Small enough for an interpreter, large enough that a launch is not all there is.
constexpr int kCells = 16, kTexels = 64, kWidth = 160, kHeight = 90;

/// BUILD/...: what the row's programs took, from text to their first launch's end.
std::vector<Row> build_row(const Row& timed) {
  Row row;
  row.suite = timed.suite;
  row.stage = "build";
  row.name = "build/" + timed.name;
  row.n = timed.n;
  row.variant = timed.variant;
  row.from_events = false;
  row.samples_ms = {timed.build_ms + timed.first_launch_ms};
  row.times = statistics_of(row.samples_ms);
  row.wall_ms = row.times.median;
  row.build_ms = timed.build_ms;
  row.first_launch_ms = timed.first_launch_ms;
  return {row};
}

/// The same case with its build told beside it.
Case with_build(Case described) {
  described.make = [make = std::move(described.make)] {
    Job job = make();
    job.more_rows = build_row;
    return job;
  };
  return described;
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
  const Variant plain = plain_variant(options, basis);
  for (const StageJob& job : kStageJobs)
    cases.push_back(with_build(stage_case(*bench, "regression", job, plain)));
  Variant blocked = plain;
  blocked.options.occlusion = true;
  for (const StageJob& job : {kPropagate, kSweep})
    cases.push_back(with_build(stage_case(*bench, "regression", job, blocked)));
  Variant halves = plain;
  halves.options.storage = Storage::float16;
  for (const StageJob& job : {kPropagate, kSweep})
    cases.push_back(with_build(stage_case(*bench, "regression", job, halves)));
  return cases;
}

std::vector<Case> layouts_of(const std::shared_ptr<Bench>& bench, const SuiteOptions& options) {
  std::vector<Case> cases;
  for (const Layout layout : values_of<Layout>()) {
    if (layout == Layout::soa) continue;  // stages_of has it
    Variant variant = plain_variant(options, "sh2");
    variant.options.layout = layout;
    cases.push_back(with_build(stage_case(*bench, "regression", kPropagate, variant)));
  }
  return cases;
}

}  // namespace

Suite regression_suite() {
  return {"regression",
          "small and fixed: every kind of kernel, and how long it took to build, for who works on a driver",
          [](Session& session, const SuiteOptions& given) {
            const SuiteOptions options = small(given);
            const auto bench = make_bench(session, options, options.settings);
            const auto names =
                options.bases.empty() ? std::vector<std::string>{"sh2", "srbf8v2", "bins24"} : options.bases;
            std::vector<Group> groups = group_a_basis(names, [bench, options](const std::string& basis) {
              return stages_of(bench, options, basis);
            });
            groups.push_back({[bench, options] { return layouts_of(bench, options); }});
            return groups;
          },
          {}};
}

}  // namespace clpv::bench
