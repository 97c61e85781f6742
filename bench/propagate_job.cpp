// Stage `propagate` as a job.
#include <fmt/format.h>

#include <cmath>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "bench/propagate_twin.hpp"
#include "bench/stage_jobs.hpp"
#include "pipeline/propagate.hpp"
#include "reference/tolerances.hpp"

namespace clpv::bench {
namespace {

constexpr double kChannels = 3;

/// All that one propagation needs, alive as long as its job.
struct Propagation {
  Variant variant;
  std::unique_ptr<Basis> basis;
  Transport transport;
  Volume injected, accumulated;
  std::unique_ptr<Volume> geometry;
  Propagator propagator;

  Propagation(Session& session, const Variant& v)
      : variant(v),
        basis(make_basis(v.basis, v.lambda)),
        transport(make_transport(v.transport, *basis, lobe_options(v))),
        injected(session, {v.grid, basis->size(), 3}, "bench: injected light"),
        accumulated(session, {v.grid, basis->size(), 3}, "bench: accumulated light"),
        propagator(session, *basis, transport, {.grid = v.grid, .state = state_of(v)}) {
    if (v.occlusion)
      geometry = std::make_unique<Volume>(session, VolumeShape{v.grid + 1, basis->size(), 1},
                                          "bench: geometry volume");
  }
};

/// Adds what one launch per step moves: `values` a cell, of all channels.
void add_step(Cost& cost, double cells, double values, double flops) {
  cost.bytes += cells * values * sizeof(float);
  cost.flops += cells * flops;
}

/// Counted for the kernels as generated, after a run has made them.
Cost cost_of(Propagation& p) {
  const double cells = std::pow(p.variant.grid, 3), n = p.basis->size();
  const bool fluxes = p.variant.state == "fluxes";
  const double carried = fluxes ? 6 : n;
  const Transmitter* transmitter = p.propagator.transmitter();
  const double ways = transmitter != nullptr ? transmitter->transmittance().shape().coefficients : 0;
  Cost cost;
  for (int step = 1; step <= p.variant.iterations; ++step) {
    const bool blocked = transmitter != nullptr && step > 1;
    const TransportSource source =
        step == 1 ? transport_source(*p.basis, p.transport, {State::coefficients, state_of(p.variant), false})
                  : p.propagator.step_source(blocked);
    // Travelling light and the sum in, both out; the first step of coefficients finds the sum where its source is.
    const double in = source.source_count + (step == 1 && !fluxes ? 0.0 : carried);
    add_step(cost, cells, kChannels * (in + 2 * carried) + (blocked ? ways : 0.0),
             kChannels * (source.arrive.flops() + carried));
    cost.reads_per_cell =
        kChannels * (source.neighbours * source.source_count + carried) + (blocked ? ways : 0.0);
  }
  if (transmitter != nullptr)
    add_step(cost, cells, n * std::pow((p.variant.grid + 1.0) / p.variant.grid, 3) + ways,
             transmitter->operations().flops());
  if (fluxes) add_step(cost, cells, kChannels * (2 * n + carried), kChannels * (2 * 6 * n + n));
  cost.writes_per_cell = kChannels * 2 * carried;
  cost.working_set = cells * sizeof(float) * (3 * kChannels * carried + ways);
  return cost;
}

std::string twin_key(const Variant& v) {
  return fmt::format("propagate {} {} {} {} {} {} {} {}", v.basis, v.lambda, v.transport, v.lobe, v.occlusion,
                     v.grid, v.iterations, v.cascade.value_or(0));
}

Deviation compare(const std::vector<float>& device, const std::vector<double>& twin, int n,
                  double tolerance) {
  Deviation deviation{0, tolerance, {}};
  double largest = 0;
  for (const double value : twin) largest = std::max(largest, std::abs(value));
  for (std::size_t at = 0; at < twin.size(); ++at) {
    const double error = std::abs(device[at] - twin[at]) / largest;
    if (error <= deviation.worst) continue;  // a NaN is not, and stays the worst
    deviation.worst = error;
    const auto side = static_cast<std::size_t>(n);
    deviation.place = fmt::format("cell {},{},{} plane {}: {:.7g}, twin {:.7g}", at % side, at / side % side,
                                  at / side / side % side, at / side / side / side, device[at], twin[at]);
    if (std::isnan(error)) break;
  }
  return deviation;
}

}  // namespace

Job propagate_job(Bench& bench, const Variant& variant) {
  Session& session = bench.session;
  const auto p = std::make_shared<Propagation>(session, variant);
  const int cascade = variant.cascade.value_or(0);
  p->injected.write(session, bench.inputs->light(*p->basis, cascade));
  if (p->geometry) p->geometry->write(session, bench.inputs->geometry(*p->basis, cascade));
  const PropagateVolumes volumes{p->injected, p->geometry.get(), p->accumulated};
  p->propagator.propagate(volumes, std::min(2, variant.iterations));  // makes the kernels that are counted
  Job job;
  job.cost = cost_of(*p);
  job.reset = [p, &session] { p->accumulated.clear(session); };
  job.run = [p] {
    p->propagator.propagate({p->injected, p->geometry.get(), p->accumulated}, p->variant.iterations);
  };
  job.verify = [p, &bench, cascade] {
    const int grid = p->variant.grid, n = p->basis->size();
    const auto twin = bench.twin(twin_key(p->variant), [&] {
      const auto light = to_reference(bench.inputs->light(*p->basis, cascade), grid, n, 3);
      if (!p->geometry) return propagated(*p->basis, p->transport, light, nullptr, p->variant.iterations);
      const auto geometry = to_reference(bench.inputs->geometry(*p->basis, cascade), grid + 1, n, 1);
      return propagated(*p->basis, p->transport, light, &geometry, p->variant.iterations);
    });
    return compare(p->accumulated.read(bench.session), *twin, grid, reference::tolerance("propagate"));
  };
  return job;
}

}  // namespace clpv::bench
