// SPDX-License-Identifier: MIT
// Suite `layouts`: every stage on every layout and storage of its volumes, and how often each reaches into them: the
// paper's own argument is about texture reads.
#include <fmt/format.h>

#include <algorithm>

#include "bench/suites.hpp"
#include "volume/volume_format.hpp"

namespace clpv::bench {
namespace {

// As the paper has it: what the others' speed-up is told over.
constexpr VolumeFormat kPaperFormat{Layout::image, Storage::float16};

struct Timed {
  StageJob job;
  bool occlusion;
};

/// One stage of one basis in every format: timed interleaved.
std::vector<Case> cases(Bench& bench, const SuiteOptions& options, const std::string& basis,
                        const Timed& timed) {
  std::vector<Case> cases;
  for (const VolumeFormat& format : all_formats()) {
    Variant variant = plain_variant(options, basis);
    variant.options.layout = format.layout, variant.options.storage = format.storage;
    variant.options.occlusion = timed.occlusion;
    cases.push_back(stage_case(bench, "layouts", timed.job, variant));
    if (timed.job.stage != Stage::gather || format.layout != Layout::image) continue;
    variant.filtered = false;
    cases.push_back(stage_case(bench, "layouts", timed.job, variant));
  }
  return cases;
}

/// The row of half-float images that does the same work.
const Row* paper_row(const std::vector<Row>& rows, const Row& row) {
  for (const Row& other : rows) {
    const RenderOptions &a = row.variant->options, &b = other.variant->options;
    if (other.status == Status::ok && other.stage == row.stage && a.basis == b.basis &&
        a.occlusion == b.occlusion && b.format() == kPaperFormat && other.variant->filtered)
      return &other;
  }
  return nullptr;
}

std::string layouts_table(const std::vector<Row>& rows) {
  const std::size_t width = name_width(rows);
  const std::string text =
      fmt::format("{:<{}} {:>10} {:>9} {:>12} {:>12} {:>8} {:>16} {:>16} {:>9}\n", "row", width, "median ms",
                  "mad", "reads/cell", "writes/cell", "GB/s", "of ceiling", "over image/half", "error");
  const auto columns = [&](const Row& row) {
    const Row* paper = paper_row(rows, row);
    return fmt::format(
        "{:>10.3f} {:>9.3f} {:>12.0f} {:>12.0f} {:>8.1f} {:>16} {:>16} {:>9.1e}", row.times.median,
        row.times.mad, row.cost.reads_per_cell, row.cost.writes_per_cell, row.gbps(),
        fmt::format("{:.0f}% {}", 100 * row.ceiling_share, row.ceiling),
        paper != nullptr ? fmt::format("{:.1f}x", paper->times.median / row.times.median) : "-",
        row.max_rel_error.value_or(0));
  };
  return text + row_lines(rows, width, columns) +
         "\nreads and writes: of numbers, or of texels of four, by a cell in one later step (all channels); "
         "of sweep, in all; of gather, by a pixel in one cascade.\n";
}

}  // namespace

Suite layouts_suite() {
  return {
      "layouts", "each stage on each layout and storage of volumes; reads, writes, speed-up over half images",
      [](Session& session, const SuiteOptions& options) {
        const auto bench = make_bench(session, options, options.settings);
        const auto bases = options.bases.empty() ? std::vector<std::string>{"sh2", "srbf8v2"} : options.bases;
        std::vector<Group> groups;
        const auto add = [&](const Timed& timed, const std::vector<std::string>& of) {
          std::ranges::move(
              group_a_basis(of,
                            [=](const std::string& basis) { return cases(*bench, options, basis, timed); }),
              std::back_inserter(groups));
        };
        for (const Timed& timed : {Timed{kInject, false}, {kPropagate, false}, {kPropagate, true}})
          add(timed, bases);
        // A sweep reads a basis once and keeps light its own way: of one basis, the defaults', all is told.
        for (const bool occlusion : {false, true})
          add({kSweep, occlusion}, options.bases.empty() ? std::vector{RenderOptions{}.basis} : bases);
        add({kGather, false}, bases);
        return groups;
      },
      layouts_table};
}

}  // namespace clpv::bench
