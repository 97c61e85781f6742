// SPDX-License-Identifier: MIT
// Suite `layouts`: every stage with every layout and storage of its volumes.

#include <fmt/format.h>

#include <algorithm>

#include "basis/basis.hpp"
#include "bench/suites.hpp"
#include "support/named_enum.hpp"
#include "volume/volume_format.hpp"

namespace clpv::bench {

namespace {

// The paper's format, denominator of the speed-ups.
constexpr VolumeFormat kPaperFormat{Layout::image, Storage::float16};

struct StageSetup {
  StageJob job;
  bool occlusion;
};

/// One stage of one basis in every format.
Group cases(const std::shared_ptr<Bench>& bench, const SuiteOptions& options,
            const std::string& basis, const StageSetup& setup) {
  Group cases;
  for (const VolumeFormat& format : all_formats()) {
    Problem problem = basis_problem(options, basis);
    problem.options.layout = format.layout, problem.options.storage = format.storage;
    problem.options.blockers = blockers_if(setup.occlusion);
    cases.push_back(stage_case(bench, "layouts", setup.job, problem));
    if (setup.job.stage != Stage::gather || format.layout != Layout::image) continue;
    problem.filtered = false;
    cases.push_back(stage_case(bench, "layouts", setup.job, problem));
  }
  return cases;
}

/// The row of the same stage, basis and occlusion in half-float images; null if there is none.
const Row* paper_row(const std::vector<Row>& rows, const Row& row) {
  for (const Row& other : rows) {
    const RenderOptions &a = row.problem.options, &b = other.problem.options;
    if (other.status == Status::ok && other.stage == row.stage && a.basis == b.basis &&
        a.blocked() == b.blocked() && b.format() == kPaperFormat && other.problem.filtered)
      return &other;
  }
  return nullptr;
}

std::string layouts_table(const std::vector<Row>& rows) {
  const std::size_t width = name_width(rows);
  const std::string text = fmt::format("{:<{}} {:>10} {:>9} {:>16} {:>9}\n", "row", width,
                                       "median ms", "mad", "vs image/half", "error");
  const auto columns = [&](const Row& row) {
    const Row* paper = paper_row(rows, row);
    return fmt::format(
        "{:>10.3f} {:>9.3f} {:>16} {:>9}", row.times.median, row.times.mad,
        paper != nullptr ? fmt::format("{:.1f}x", paper->times.median / row.times.median) : "-",
        error_text(row));
  };
  return text + row_lines(rows, width, columns) +
         "\nvs image/half: speed-up over half-float images.\n";
}

// Suite `bases`: the cost of every basis, with both lobes.

Group cases_of(const std::shared_ptr<Bench>& bench, const SuiteOptions& options,
               const std::string& basis) {
  Group cases;
  const Problem usual = basis_problem(options, basis);
  cases.push_back(stage_case(bench, "bases", kInject, usual));
  Problem problem = usual;
  for (const LobeKind lobe : values_of<LobeKind>()) {
    for (const bool occlusion : {false, true}) {
      problem.options.lobe = lobe, problem.options.blockers = blockers_if(occlusion);
      cases.push_back(stage_case(bench, "bases", kPropagate, problem));
    }
  }
  // The sweep's blockers are areas and do not depend on the basis: no case with occlusion.
  cases.push_back(stage_case(bench, "bases", kSweep, usual));
  cases.push_back(stage_case(bench, "bases", kGather, usual));
  return cases;
}

}  // namespace

Suite layouts_suite() {
  return {"layouts",
          "each stage with each layout and storage of volumes: speed-up over half-float images",
          [](Session& session, const SuiteOptions& options) {
            const auto bench = make_bench(session, options, options.settings);
            const auto bases =
                options.bases.empty() ? std::vector<std::string>{"sh2", "srbf8v2"} : options.bases;
            std::vector<Group> groups;
            const auto add = [&](const StageSetup& setup, const std::vector<std::string>& names) {
              for (const std::string& basis : names)
                groups.push_back(cases(bench, options, basis, setup));
            };
            for (const StageSetup& setup :
                 {StageSetup{kInject, false}, {kPropagate, false}, {kPropagate, true}})
              add(setup, bases);
            // The sweep stores light in its own layout and reads the basis once: by default, one
            // basis is enough.
            for (const bool occlusion : {false, true})
              add({kSweep, occlusion},
                  options.bases.empty() ? std::vector{RenderOptions{}.basis} : bases);
            add({kGather, false}, bases);
            return groups;
          },
          layouts_table};
}

Suite bases_suite() {
  return {"bases",
          "every basis with both lobes: injection, propagation, sweep, gathering",
          [](Session& session, const SuiteOptions& options) {
            const auto bench = make_bench(session, options, options.settings);
            std::vector<Group> groups;
            for (const std::string& basis : options.bases.empty() ? basis_names() : options.bases)
              groups.push_back(cases_of(bench, options, basis));
            return groups;
          },
          {}};
}

}  // namespace clpv::bench
