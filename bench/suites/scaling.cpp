// SPDX-License-Identifier: MIT
// Suite `scaling`: growth of times with grid, coefficients, steps, RSM, triangles and compute
// units.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include "basis/basis.hpp"
#include "bench/hall.hpp"
#include "bench/suites.hpp"

namespace clpv::bench {
namespace {

/// Sets the row's axis and value, and appends them to its name ("/grid:64").
void set_axis(Row& row, const std::string& axis, int value) {
  row.axis = axis, row.value = value;
  row.name += fmt::format("/{}:{}", axis, value);
}

Case scaling_case(const std::shared_ptr<Bench>& bench, const StageJob& job, const Problem& problem,
                  const std::string& axis, int value) {
  Case result = stage_case(*bench, "scaling", job, problem);
  set_axis(result.row, axis, value);
  return result;
}

std::vector<Case> grids(Session& session, const SuiteOptions& options, const std::string& basis) {
  std::vector<Case> cases;
  for (const int grid : {16, 32, 48, 64, 96, 128}) {
    RenderOptions settings = options.settings;
    settings.grid = grid, settings.cascades = 1;
    const auto bench = make_bench(session, options, settings);
    Problem problem = basis_problem(options, basis);
    problem.options.grid = grid;
    for (const StageJob& job : {kPropagate, kInject}) {
      Case added = scaling_case(bench, job, problem, "grid", grid);
      added.make = [bench, make = std::move(added.make)] {
        return make();
      };  // keeps the bench alive
      cases.push_back(std::move(added));
    }
  }
  return cases;
}

std::vector<Case> coefficients(const std::shared_ptr<Bench>& bench, const SuiteOptions& options) {
  std::vector<Case> cases;
  for (const std::string basis : {"sh2", "srbf6", "srbf8v2", "sh3", "srbf14", "sh4", "sh5"}) {
    const Problem problem = basis_problem(options, basis);
    const int n = make_basis(basis)->size();
    for (const StageJob& job : kStageJobs)
      cases.push_back(scaling_case(bench, job, problem, "n", n));
  }
  return cases;
}

std::vector<Case> steps(const std::shared_ptr<Bench>& bench, const SuiteOptions& options,
                        const std::string& basis) {
  std::vector<Case> cases;
  for (const int iterations : {4, 8, 16, 32, 64}) {
    Problem problem = basis_problem(options, basis);
    problem.options.iterations = iterations;
    cases.push_back(scaling_case(bench, kPropagate, problem, "iterations", iterations));
  }
  return cases;
}

/// A case of rasterising, without basis and volumes.
Case raster_case(Session& session, std::shared_ptr<const SceneData> scene, Pass pass,
                 const RenderOptions& settings, const std::string& axis, int value) {
  Case result;
  Row& row = result.row;
  row.suite = "scaling", row.stage = row.name = name_of(pass);
  set_axis(row, axis, value);
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
    Case added = scaling_case(bench, kInject, basis_problem(options, basis), "rsm", size);
    added.make = [bench, make = std::move(added.make)] { return make(); };
    cases.push_back(std::move(added));
    cases.push_back(raster_case(session, scene, Pass::rasterize_rsm, settings, "rsm", size));
  }
  return cases;
}

std::vector<Case> triangles(Session& session, const SuiteOptions& options) {
  std::vector<Case> cases;
  RenderOptions settings = options.settings;
  settings.cascades = 1;
  for (const int count : {1000, 4000, 16000, 64000, 256000}) {
    const auto hall = std::make_shared<const SceneData>(make_hall(count));
    for (const Pass pass : {Pass::rasterize_rsm, Pass::rasterize_camera}) {
      cases.push_back(raster_case(session, hall, pass, settings, "triangles",
                                  static_cast<int>(hall->triangles.size())));
    }
  }
  return cases;
}

/// Propagation on a sub-device of `units` compute units, in a separate session and therefore with
/// wall times.
Case units_case(Session& session, const SuiteOptions& options, const std::string& basis,
                unsigned units) {
  Case result;
  const Problem problem = basis_problem(options, basis);
  result.row = make_row("scaling", name_of(Stage::propagate), problem);
  set_axis(result.row, "units", static_cast<int>(units));
  result.make = [&session, options, problem, units] {
    const auto part_session = std::make_shared<Session>(sub_device(session.device(), units));
    RenderOptions settings = options.settings;
    settings.cascades = 1;
    const auto bench = make_bench(*part_session, options, settings);
    Job job = propagate_job(*bench, problem);
    const auto finish = [part_session, bench](const std::function<void()>& work) {
      work();
      part_session->queue().finish();
    };
    job.reset = [finish, reset = job.reset] { finish(reset); };
    job.run = [finish, part_session, run = job.run] {
      part_session->timeline().clear();
      finish(run);
    };
    job.own_stages = true;
    return job;
  };
  return result;
}

/// Least-squares slope of log y over log x: y grows as x to this power. Needs two different x; all
/// values positive.
double growth_exponent(const std::vector<double>& x, const std::vector<double>& y) {
  double mean_x = 0, mean_y = 0, covariance = 0, variance = 0;
  const auto count = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += std::log(x[i]) / count;
    mean_y += std::log(y[i]) / count;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = std::log(x[i]) - mean_x;
    covariance += dx * (std::log(y[i]) - mean_y);
    variance += dx * dx;
  }
  return covariance / variance;
}

/// Time of a propagation per cell and step [ns]; "-" for other stages.
std::string ns_per_cell_step(const Row& row) {
  if (row.stage != name_of(Stage::propagate) || !row.problem) return "-";
  const RenderOptions& o = row.problem->options;
  return fmt::format("{:.3f}", row.times.median * 1e6 / (std::pow(o.grid, 3) * o.iterations));
}

std::string scaling_table(const std::vector<Row>& rows) {
  std::map<std::pair<std::string, std::string>, std::pair<std::vector<double>, std::vector<double>>>
      series;
  constexpr std::size_t kWidth = 44;
  std::string text = fmt::format("{:<{}} {:>10} {:>9} {:>14} {:>14}\n", "row", kWidth, "median ms",
                                 "mad", "ns/cell/step", "of ceiling");
  text += row_lines(rows, kWidth, [](const Row& row) {
    return fmt::format("{:>10.3f} {:>9.3f} {:>14} {:>14}", row.times.median, row.times.mad,
                       ns_per_cell_step(row),
                       fmt::format("{:.0f}% {}", 100 * row.ceiling_share, row.ceiling));
  });
  for (const Row& row : rows) {
    if (row.status == Status::unsupported) continue;
    const bool one_basis = row.axis != "n" && row.problem;
    auto& [x, y] =
        series[{row.axis, row.stage + (one_basis ? "/" + row.problem->options.basis : "")}];
    x.push_back(row.value), y.push_back(row.times.median);
  }
  text += "\nexponents of growth: time ~ value^exponent\n";
  for (const auto& [key, points] : series) {
    const auto& [x, y] = points;
    if (std::set<double>(x.begin(), x.end()).size() < 2) continue;
    text += fmt::format("  {:<12} {:<28} {:>6.2f}\n", key.first, key.second, growth_exponent(x, y));
  }
  return text;
}

}  // namespace

Suite scaling_suite() {
  return {"scaling",
          "growth with grid, coefficients, steps, RSM, triangles and compute units: exponents",
          [](Session& session, const SuiteOptions& options) {
            const std::string basis = options.bases.empty() ? "sh2" : options.bases.front();
            const auto bench = make_bench(session, options, options.settings);
            return std::vector<Group>{
                {[&session, options, basis] { return grids(session, options, basis); }},
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
