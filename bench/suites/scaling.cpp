// SPDX-License-Identifier: MIT
// Suite `scaling`: how times grow with the grid, the coefficients, the steps, the RSM, the triangles, the compute units and
// the ranks.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include "basis/basis.hpp"
#include "bench/hall.hpp"
#include "bench/statistics.hpp"
#include "bench/suites.hpp"

namespace clpv::bench {
namespace {

constexpr int kFramesEach = 8;  // enough for handing them out to take no part of their time

/// What a row is a point of; its name ends with it as well: "/grid:64".
void place(Row& row, const std::string& axis, int value) {
  row.axis = axis, row.value = value;
  row.name += fmt::format("/{}:{}", axis, value);
}

Case stage_at(const std::shared_ptr<Bench>& bench, const StageJob& job, const Variant& variant,
              const std::string& axis, int value) {
  Case made = stage_case(*bench, "scaling", job, variant);
  place(made.row, axis, value);
  return made;
}

std::vector<Case> grids(Session& session, const SuiteOptions& options, const std::string& basis) {
  std::vector<Case> cases;
  for (const int grid : {16, 32, 48, 64, 96, 128}) {
    RenderOptions settings = options.settings;
    settings.grid = grid, settings.cascades = 1;
    const auto bench = make_bench(session, options, settings);
    Variant variant = plain_variant(options, basis);
    variant.options.grid = grid;
    for (const StageJob& job : {kPropagate, kInject}) {
      Case made = stage_at(bench, job, variant, "grid", grid);
      made.make = [bench, make = std::move(made.make)] { return make(); };  // the bench lives as long
      cases.push_back(std::move(made));
    }
  }
  return cases;
}

std::vector<Case> coefficients(const std::shared_ptr<Bench>& bench, const SuiteOptions& options) {
  std::vector<Case> cases;
  for (const std::string basis : {"sh2", "srbf6", "srbf8v2", "sh3", "srbf14", "sh4", "sh5"}) {
    const Variant variant = plain_variant(options, basis);
    const int n = make_basis(basis)->size();
    for (const StageJob& job : kStageJobs) cases.push_back(stage_at(bench, job, variant, "n", n));
  }
  return cases;
}

std::vector<Case> steps(const std::shared_ptr<Bench>& bench, const SuiteOptions& options,
                        const std::string& basis) {
  std::vector<Case> cases;
  for (const int iterations : {4, 8, 16, 32, 64}) {
    Variant variant = plain_variant(options, basis);
    variant.options.iterations = iterations;
    cases.push_back(stage_at(bench, kPropagate, variant, "iterations", iterations));
  }
  return cases;
}

/// A row for rasterising alone: no basis, no volumes.
Case raster_case(Session& session, std::shared_ptr<const Scene> scene, Pass pass,
                 const RenderOptions& settings, const std::string& axis, int value) {
  Case result;
  Row& row = result.row;
  row.suite = "scaling", row.stage = row.name = name_of(pass);
  place(row, axis, value);
  result.make = [&session, scene = std::move(scene), pass, settings] {
    return rasterize_job(session, scene, {}, pass, settings);
  };
  return result;
}

std::vector<Case> rsms(Session& session, const SuiteOptions& options, const std::string& basis) {
  std::vector<Case> cases;
  const auto scene = scene_of(options);
  for (const int size : {128, 256, 512, 1024}) {
    RenderOptions settings = options.settings;
    settings.rsm_size = size, settings.cascades = 1;
    const auto bench = make_bench(session, options, settings);
    Case made = stage_at(bench, kInject, plain_variant(options, basis), "rsm", size);
    made.make = [bench, make = std::move(made.make)] { return make(); };
    cases.push_back(std::move(made));
    cases.push_back(raster_case(session, scene, Pass::rasterize_rsm, settings, "rsm", size));
  }
  return cases;
}

std::vector<Case> triangles(Session& session, const SuiteOptions& options) {
  std::vector<Case> cases;
  RenderOptions settings = options.settings;
  settings.cascades = 1;
  for (const int count : {1000, 4000, 16000, 64000, 256000}) {
    const auto hall = std::make_shared<const Scene>(make_hall(count));
    for (const Pass pass : {Pass::rasterize_rsm, Pass::rasterize_camera}) {
      cases.push_back(
          raster_case(session, hall, pass, settings, "triangles", static_cast<int>(hall->triangles.size())));
    }
  }
  return cases;
}

/// The twin's way to run on a part of the device: its own session, so timed by the wall clock.
Case units_case(Session& session, const SuiteOptions& options, const std::string& basis, unsigned units) {
  Case result;
  const Variant variant = plain_variant(options, basis);
  result.row = make_row("scaling", name_of(Stage::propagate), variant);
  place(result.row, "units", static_cast<int>(units));
  result.make = [&session, options, variant, units] {
    const auto part = std::make_shared<Session>(part_of(session.device(), units));
    RenderOptions settings = options.settings;
    settings.cascades = 1;
    const auto bench = make_bench(*part, options, settings);
    Job job = propagate_job(*bench, variant);
    const auto wait = [part, bench](const std::function<void()>& work) {
      work();
      part->queue().finish();
    };
    job.reset = [wait, reset = job.reset] { wait(reset); };
    job.run = [wait, part, run = job.run] {
      part->timeline().clear();
      wait(run);
    };
    job.own_stages = true;
    return job;
  };
  return result;
}

/// 1, 2, 4 and so on, and all.
std::vector<int> rank_counts(int most) {
  std::vector<int> counts;
  for (int count = 1; count < most; count *= 2) counts.push_back(count);
  counts.push_back(most);
  return counts;
}

/// So many frames by one rank or more, together (strong) or each (weak).
std::vector<Case> rank_cases(const SuiteOptions& options, const std::string& basis) {
  std::vector<Case> cases;
  const int together = kFramesEach * options.ranks->most_ranks();
  for (const int ranks : rank_counts(options.ranks->most_ranks())) {
    for (const bool strong : {true, false}) {
      Case made;
      made.row = make_row("scaling", strong ? "frames-strong" : "frames-weak", plain_variant(options, basis));
      place(made.row, "ranks", ranks);
      made.make = [work = options.ranks, ranks, frames = strong ? together : kFramesEach * ranks] {
        work->render(ranks, ranks);  // each has its own to compile
        Job job;
        job.run = [work, ranks, frames] { work->render(ranks, frames); };
        job.own_stages = true;
        return job;
      };
      cases.push_back(std::move(made));
    }
  }
  return cases;
}

struct Point {
  double x, ms;
};

/// Of a propagation [ns].
std::string a_cell_step(const Row& row) {
  if (row.stage != name_of(Stage::propagate) || !row.variant) return "-";
  const RenderOptions& o = row.variant->options;
  return fmt::format("{:.3f}", row.times.median * 1e6 / (std::pow(o.grid, 3) * o.iterations));
}

std::string table(const std::vector<Row>& rows) {
  std::map<std::pair<std::string, std::string>, std::vector<Point>> all;
  constexpr std::size_t kWidth = 44;
  std::string text = fmt::format("{:<{}} {:>10} {:>9} {:>14} {:>14}\n", "row", kWidth, "median ms", "mad",
                                 "ns a cell step", "of ceiling");
  text += row_lines(rows, kWidth, [](const Row& row) {
    return fmt::format("{:>10.3f} {:>9.3f} {:>14} {:>14}", row.times.median, row.times.mad, a_cell_step(row),
                       fmt::format("{:.0f}% {}", 100 * row.ceiling_share, row.ceiling));
  });
  for (const Row& row : rows) {
    if (row.status == Status::unsupported) continue;
    const bool one_basis = row.axis != "n" && row.variant;
    all[{row.axis, row.stage + (one_basis ? "/" + row.variant->options.basis : "")}].push_back(
        {row.value, row.times.median});
  }
  text += "\ntime grows as the value to the power\n";
  for (const auto& [key, points] : all) {
    std::vector<double> x, y;
    for (const Point& point : points) x.push_back(point.x), y.push_back(point.ms);
    if (std::set<double>(x.begin(), x.end()).size() < 2) continue;
    text += fmt::format("  {:<12} {:<28} {:>6.2f}\n", key.first, key.second, growth_exponent(x, y));
  }
  return text;
}

}  // namespace

Suite scaling_suite() {
  return {"scaling",
          "growth with grid, coefficients, steps, RSM, triangles, compute units, under mpirun ranks; the "
          "exponents",
          [](Session& session, const SuiteOptions& options) {
            const std::string basis = options.bases.empty() ? "sh2" : options.bases.front();
            const auto bench = make_bench(session, options, options.settings);
            std::vector<Group> groups = {
                {[&session, options, basis] { return grids(session, options, basis); }},
                {[bench, options] { return coefficients(bench, options); }},
                {[bench, options, basis] { return steps(bench, options, basis); }},
                {[&session, options, basis] { return rsms(session, options, basis); }},
                {[&session, options] { return triangles(session, options); }},
                {[&session, options, basis] {
                  return std::vector<Case>{units_case(session, options, basis, 1),
                                           units_case(session, options, basis, 2)};
                }}};
            if (options.ranks) groups.push_back({[options, basis] { return rank_cases(options, basis); }});
            return groups;
          },
          table};
}

}  // namespace clpv::bench
