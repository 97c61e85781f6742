// SPDX-License-Identifier: MIT
#include "bench/tune.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/stencil.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/named_enum.hpp"
#include "support/progress.hpp"

namespace clpv::bench {
namespace {

/// Shapes worth trying on a grid: rows that fill it evenly, of one or more lines; the usual one first.
std::vector<Tuning> candidates(const Device& device, const Variant& variant) {
  const int usual_lanes = preferred_lanes(device, variant.options.format());
  const RenderOptions& o = variant.options;
  std::vector<Tuning> shapes = {{{0, 1}, 0, o.layout}};
  const auto limits = device.handle.getInfo<CL_DEVICE_MAX_WORK_ITEM_SIZES>();
  const auto most = device.handle.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
  for (const int lanes : {1, 8}) {
    if (lanes > most_lanes(variant.options.format())) continue;
    if (o.format() == VolumeFormat{} && lanes != usual_lanes && device.type == "cpu") continue;
    const std::size_t row = static_cast<std::size_t>((o.grid + lanes - 1) / lanes);
    for (const std::size_t x : {row, row / 2}) {
      for (const std::size_t y : {1u, 4u}) {
        if (x == 0 || x > limits[0] || y > limits[1] || x * y > most) continue;
        const Tuning shape{{x, y}, lanes, o.layout};
        if (std::count(shapes.begin(), shapes.end(), shape) == 0) shapes.push_back(shape);
      }
    }
  }
  return shapes;
}

std::string label(const Tuning& shape) {
  return shape.lanes == 0 ? std::string("/usual")
                          : fmt::format("/lanes:{}/local:{}x{}", shape.lanes, shape.local[0], shape.local[1]);
}

/// The usual shape in numbers, so that it can be kept.
Tuning spelled_out(const Device& device, const Variant& variant, Tuning shape) {
  if (shape.lanes != 0) return shape;
  const Stencil stencil(device, {.grid = variant.options.grid, .format = variant.options.format()});
  shape.lanes = stencil.lanes();
  shape.local = stencil.local();
  return shape;
}

/// The best shape on one layout; nothing where the device has not the layout.
std::optional<Tuned> best_shape(Bench& bench, const Variant& variant, const TuneOptions& options,
                                Progress& progress) {
  const Device& device = bench.session.device();
  const std::vector<Tuning> shapes = candidates(device, variant);
  std::vector<Case> cases;
  for (const Tuning& shape : shapes) {
    Variant tried = variant;
    tried.lanes = shape.lanes, tried.local = shape.local;
    cases.push_back(stage_case(bench, "tune", kPropagate, tried, label(shape)));
  }
  const std::vector<Row> rows = run_cases(bench.session, cases, {options.repetitions, nullptr, &progress});
  if (rows.front().status != Status::ok) {
    spdlog::info("{}: {} {}", rows.front().name, name_of(rows.front().status), rows.front().reason);
    return std::nullopt;
  }
  std::size_t best = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    spdlog::debug("{}: {} {:.3f} ms", rows[i].name, name_of(rows[i].status), rows[i].times.median);
    if (rows[i].status == Status::ok && rows[i].times.median < rows[best].times.median) best = i;
  }
  if (rows[best].times.median > (1 - kLeastGain) * rows[0].times.median) best = 0;
  return Tuned{tuning_subject(variant.options), spelled_out(device, variant, shapes[best]),
               rows[0].times.median, rows[best].times.median};
}

}  // namespace

SuiteOptions TuneOptions::rendering() {
  const RenderOptions rendered;
  SuiteOptions suite;
  suite.settings.transport = TransportKind::sampled;
  suite.settings.storage = rendered.storage, suite.settings.occlusion = rendered.occlusion;
  suite.bases = {"sh2"};
  return suite;
}

std::vector<Tuned> tune(Session& session, const TuneOptions& options) {
  constexpr std::size_t kMostShapes =
      9;  // of candidates(): progress counts those that are not tried as done at once
  const auto all_layouts = values_of<Layout>();
  const std::vector<Layout> layouts =
      options.layouts.empty() ? std::vector(all_layouts.begin(), all_layouts.end()) : options.layouts;
  Progress progress("tune", options.suite.bases.size() * layouts.size() * kMostShapes *
                                static_cast<std::size_t>(options.repetitions + 1));
  std::vector<Tuned> all;
  for (const std::string& basis : options.suite.bases) {
    const auto bench = make_bench(session, options.suite, options.suite.settings);
    std::vector<Tuned> found;
    for (const Layout layout : layouts) {
      stop_if_interrupted("nothing was kept");
      Variant variant = plain_variant(options.suite, basis);
      variant.options.layout = layout;
      if (auto tuned = best_shape(*bench, variant, options, progress)) found.push_back(*tuned);
    }
    if (found.empty()) throw Error(ExitCode::device, "{}: no layout can be tuned", session.device().name);
    // Not images: a device's filter rounds, and a tuning must not change what is computed.
    const auto time = [](const Tuned& t) { return t.subject.layout == Layout::image ? 1e300 : t.best_ms; };
    Tuned overall = *std::min_element(found.begin(), found.end(),
                                      [&](const Tuned& a, const Tuned& b) { return time(a) < time(b); });
    const auto soa =
        std::ranges::find_if(found, [](const Tuned& t) { return t.subject.layout == Layout::soa; });
    if (soa != found.end() && overall.best_ms > (1 - kLeastGain) * soa->best_ms) overall = *soa;
    overall.subject.layout.reset();
    overall.usual_ms = soa != found.end() ? soa->usual_ms : overall.usual_ms;
    found.push_back(overall);
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

}  // namespace clpv::bench
