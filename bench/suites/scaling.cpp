// SPDX-License-Identifier: MIT
// Suite `scaling`: how times grow with the grid, the coefficients, the steps, the RSM, the triangles and the compute units.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include "basis/basis.hpp"
#include "bench/hall.hpp"
#include "bench/suites.hpp"

namespace clpv::bench {
namespace {

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

/// The CPU reference's way to run on a part of the device: its own session, so timed by the wall clock.
Case units_case(Session& session, const SuiteOptions& options, const std::string& basis, unsigned units) {
  Case result;
  const Variant variant = plain_variant(options, basis);
  result.row = make_row("scaling", name_of(Stage::propagate), variant);
  place(result.row, "units", static_cast<int>(units));
  result.make = [&session, options, variant, units] {
    const auto part = std::make_shared<Session>(sub_device(session.device(), units));
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

/// Least-squares slope of log y over log x: y grows as x to this power. At least two different x, all positive.
double growth_exponent(const std::vector<double>& x, const std::vector<double>& y) {
  double mean_x = 0, mean_y = 0, above = 0, below = 0;
  const auto count = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += std::log(x[i]) / count;
    mean_y += std::log(y[i]) / count;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = std::log(x[i]) - mean_x;
    above += dx * (std::log(y[i]) - mean_y);
    below += dx * dx;
  }
  return above / below;
}

/// Of a propagation [ns].
std::string a_cell_step(const Row& row) {
  if (row.stage != name_of(Stage::propagate) || !row.variant) return "-";
  const RenderOptions& o = row.variant->options;
  return fmt::format("{:.3f}", row.times.median * 1e6 / (std::pow(o.grid, 3) * o.iterations));
}

std::string scaling_table(const std::vector<Row>& rows) {
  std::map<std::pair<std::string, std::string>, std::pair<std::vector<double>, std::vector<double>>> all;
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
    auto& [x, y] = all[{row.axis, row.stage + (one_basis ? "/" + row.variant->options.basis : "")}];
    x.push_back(row.value), y.push_back(row.times.median);
  }
  text += "\ntime grows as the value to the power\n";
  for (const auto& [key, points] : all) {
    const auto& [x, y] = points;
    if (std::set<double>(x.begin(), x.end()).size() < 2) continue;
    text += fmt::format("  {:<12} {:<28} {:>6.2f}\n", key.first, key.second, growth_exponent(x, y));
  }
  return text;
}

}  // namespace

Suite scaling_suite() {
  return {"scaling", "growth with grid, coefficients, steps, RSM, triangles and compute units; the exponents",
          [](Session& session, const SuiteOptions& options) {
            const std::string basis = options.bases.empty() ? "sh2" : options.bases.front();
            const auto bench = make_bench(session, options, options.settings);
            return std::vector<Group>{{[&session, options, basis] { return grids(session, options, basis); }},
                                      {[bench, options] { return coefficients(bench, options); }},
                                      {[bench, options, basis] { return steps(bench, options, basis); }},
                                      {[&session, options, basis] { return rsms(session, options, basis); }},
                                      {[&session, options] { return triangles(session, options); }},
                                      {[&session, options, basis] {
                                        return std::vector<Case>{units_case(session, options, basis, 1),
                                                                 units_case(session, options, basis, 2)};
                                      }}};
          },
          scaling_table};
}

}  // namespace clpv::bench
