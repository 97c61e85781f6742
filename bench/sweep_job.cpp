// SPDX-License-Identifier: MIT
// Job of stage `sweep`: one cascade with a dark border.
#include <fmt/format.h>

#include <cmath>

#include "basis/basis.hpp"
#include "basis/sweep.hpp"
#include "basis/transport.hpp"
#include "bench/stage_jobs.hpp"
#include "codegen/sweep_source.hpp"
#include "codegen/transmittance_source.hpp"
#include "pipeline/sweep/sweep.hpp"
#include "reference/sweep.hpp"
#include "verify/tolerances.hpp"

namespace clpv::bench {
namespace {

/// Volumes and kernels of the sweep of one cascade.
struct CascadeSweep {
  Variant variant;
  std::size_t cascade;
  std::unique_ptr<Basis> basis;
  Transport transport;
  SweepOptions options;
  std::vector<ClpvGrid> grids;  ///< the cascade's grid only
  Volume injected, accumulated;
  std::unique_ptr<Volume> geometry;
  Sweeper sweeper;

  CascadeSweep(Session& session, Inputs& inputs, const Variant& v)
      : variant(v),
        cascade(static_cast<std::size_t>(v.cascade.value_or(0))),
        basis(make_basis(v.options)),
        transport(make_transport(v.options, *basis)),
        options(options_of(v.options, cascade)),
        grids({inputs.grids().at(cascade)}),
        injected(session, {options.grid, basis->size(), 3}, "bench: injected light", options.format),
        accumulated(session, {options.grid, swept_basis()->size(), 3}, "bench: swept light", options.format),
        sweeper(session, *basis, transport, options) {
    injected.write(session, inputs.light(*basis, v.cascade.value_or(0)));
    if (!options.blocking) return;
    geometry = std::make_unique<Volume>(session, corners(), "bench: geometry volume", options.format);
    geometry->write(session, inputs.areas(v.cascade.value_or(0)));
  }

  /// A frame's options, for one of its cascades.
  static SweepOptions options_of(const RenderOptions& options, std::size_t cascade) {
    SweepOptions cascade_options = sweep_options(options);
    cascade_options.parts = {cascade_options.parts.at(cascade)};
    return cascade_options;
  }
  VolumeShape corners() const { return {options.grid + 1, blocking_size(transport.blocking, *basis), 1}; }
  double directions() const { return kSweepBins * std::pow(options.parts.front(), 2); }

  void run() {
    if (geometry) sweeper.set_blockers(0, *geometry);
    sweeper.sweep({0, grids, injected}, accumulated);
  }
};

/// Cost of the kernels in use, without sources: few rows hold light. Plane buffers and sums have the sweep's layout, not
/// that of the volumes.
Cost cost_of(const CascadeSweep& p) {
  const VolumeFormat& format = p.options.format;
  const double n = p.options.grid, cells = n * n * n, corners = (n + 1) * (n + 1) * (n + 1);
  const int coefficients = p.basis->size(), harmonics = swept_basis()->size();
  const double bins = kChannels * kSweepBins, links = p.geometry ? link_volumes().count() : 0;
  const double swept = kChannels * p.directions(), sides = 2 * swept * n * n;
  const auto number = static_cast<double>(number_bytes(format.storage));
  const double light = kChannels * static_cast<double>(bytes_per_cell(format, coefficients) +
                                                       bytes_per_cell(format, harmonics));
  // With a launch per plane, each launch reads one plane of every direction and writes the next; the dark border is read.
  const double planes = p.sweeper.whole_bins() ? 1 : 1 + 2 * n, dark = p.sweeper.whole_bins() ? 0 : 2 * sides;
  Cost cost;
  cost.bytes =
      cells * (light + (2 * bins + links) * number) + dark * number + swept * n * n * sizeof(float) * planes;
  const double flops_per_direction = kChannels * (4 + 1) * 2 + (p.geometry ? 4 : 0);
  cost.flops =
      cells * (kChannels * sweep_collect_text().operations.flops() + p.directions() * flops_per_direction);
  cost.reads_per_cell = kChannels * accesses_per_cell(format, coefficients) + bins;
  cost.writes_per_cell = kChannels * accesses_per_cell(format, harmonics) + bins;
  cost.working_set =
      cells * (light + (bins + links) * number) + dark * number / 2 + swept * n * n * sizeof(float);
  if (!p.geometry) return cost;
  const int areas = p.corners().coefficients;
  cost.bytes += corners * static_cast<double>(bytes_per_cell(format, areas)) + cells * links * number;
  cost.flops += cells * transmittance_source(*p.basis, p.transport).operations.flops();
  cost.reads_per_cell += 8 * accesses_per_cell(format, areas) + 4 * kSweepBins;
  cost.writes_per_cell += links;
  return cost;
}

std::string sweep_reference_key(const Variant& v) {
  const RenderOptions& o = v.options;
  return fmt::format("sweep {} {} {} {} {} {}", o.basis, name_of(o.directions), name_of(o.blocking),
                     o.blocked(), o.grid, v.cascade.value_or(0));
}

/// Expected accumulated light, in Volume's host order.
std::vector<double> expected_light(Inputs& inputs, const Variant& variant) {
  const RenderOptions& o = variant.options;
  const int cascade = variant.cascade.value_or(0);
  const auto basis = make_basis(o);
  const Transport transport = make_transport(o, *basis);
  const reference::Volume light = to_reference(inputs.light(*basis, cascade), o.grid, basis->size(), 3);
  reference::SweptCascade swept{inputs.grids().at(cascade), &light, nullptr,
                                sweep_options(o).parts.at(cascade)};
  reference::Volume areas;
  if (o.blocked()) {
    areas = to_reference(inputs.areas(cascade), o.grid + 1, blocking_size(o.blocking, *basis), 1);
    swept.geometry = &areas;
  }
  return reference::project_bins(reference::sweep(*basis, transport, {swept}).front()).values;
}

}  // namespace

Job sweep_job(Bench& bench, const Variant& variant) {
  Session& session = bench.session;
  const auto p = std::make_shared<CascadeSweep>(session, bench.inputs(), variant);
  Job job;
  job.cost = cost_of(*p);
  job.reset = [p, &session] { p->accumulated.clear(session); };
  job.run = [p] { p->run(); };
  job.verify = [p, &bench] {
    const auto expected = bench.expected(sweep_reference_key(p->variant),
                                         [&] { return expected_light(bench.inputs(), p->variant); });
    return compare_volumes(p->accumulated.read(bench.session), *expected, p->options.grid,
                           reference::tolerance("sweep", p->options.format.storage));
  };
  return job;
}

}  // namespace clpv::bench
