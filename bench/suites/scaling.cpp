// SPDX-License-Identifier: MIT
// Suite `scaling`: how times grow with the grid, the coefficients, the steps, the RSM, the triangles and the compute
// units.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include "basis/basis.hpp"
#include "bench/hall.hpp"
#include "bench/statistics.hpp"
#include "bench/suites.hpp"
#include "support/error.hpp"

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

/// The device split into parts of `units` compute units; a session on the first of them.
std::shared_ptr<Session> part_of(const Device& device, unsigned units) {
  Device part = device;
  if (units != device.compute_units) {
    const cl_device_partition_property by_counts[] = {CL_DEVICE_PARTITION_BY_COUNTS,
                                                      static_cast<cl_device_partition_property>(units),
                                                      CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
    std::vector<cl::Device> parts;
    try {
      cl::Device(device.handle).createSubDevices(by_counts, &parts);
    } catch (const cl::Error&) {
      parts.clear();
    }
    if (parts.empty()) throw Error(ExitCode::device, "{} cannot be split into compute units", device.name);
    part.handle = parts.front();
    part.compute_units = units;
  }
  return std::make_shared<Session>(part);
}

/// The twin's way to run on a part of the device: its own session, so timed by the wall clock.
Case units_case(Session& session, const SuiteOptions& options, const std::string& basis, unsigned units) {
  Case result;
  const Variant variant = plain_variant(options, basis);
  result.row = make_row("scaling", name_of(Stage::propagate), variant);
  place(result.row, "units", static_cast<int>(units));
  result.make = [&session, options, variant, units] {
    const auto part = part_of(session.device(), units);
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
  std::string text = fmt::format("{:<44} {:>10} {:>9} {:>14} {:>14}\n", "row", "median ms", "mad",
                                 "ns a cell step", "of ceiling");
  for (const Row& row : rows) {
    if (row.status == Status::unsupported) {
      text += fmt::format("{:<44} unsupported: {}\n", row.name, row.reason);
      continue;
    }
    text +=
        fmt::format("{:<44} {:>10.3f} {:>9.3f} {:>14} {:>14}{}\n", row.name, row.times.median, row.times.mad,
                    a_cell_step(row), fmt::format("{:.0f}% {}", 100 * row.ceiling_share, row.ceiling),
                    row.status == Status::wrong ? "  WRONG" : "");
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
  return {"scaling", "growth with grid, coefficients, steps, RSM, triangles, compute units; the exponents",
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
            return groups;
          },
          table};
}

}  // namespace clpv::bench
