// SPDX-License-Identifier: MIT
// Propagation: kernels against CPU reference on a small grid of random light and random blockers.
#include "pipeline/propagate.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <random>
#include <set>
#include <string>

#include "reference/propagate.hpp"
#include "support/named_enum.hpp"
#include "verify/check.hpp"
#include "verify/inputs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::reference {
namespace {

constexpr int kGrid = 7;         // no multiple of a work-group: tests borders and partial work-groups
constexpr int kFormatGrid = 17;  // whole blocks of 8 cells plus one cell
constexpr int kSteps = 5;        // light crosses the grid and meets blockers

CheckResult check_one(Session& session, const Basis& basis, const Transport& transport,
                      const PropagateOptions& options, bool blockers) {
  std::mt19937 random(7);
  const int n = options.grid;
  const Volume light = random_light(basis, n, random);
  const Volume geometry = random_blockers(blocking_size(transport.blocking, basis), n, random);
  const clpv::Volume injected = on_device(session, light, options.format),
                     corners = on_device(session, geometry, options.format);
  clpv::Volume accumulated(session, {n, basis.size(), 3}, "check: accumulated light", options.format);
  Propagator propagator(session, basis, transport, options);
  propagator.propagate({injected, blockers ? &corners : nullptr, accumulated}, kSteps);
  const Propagation expected = propagate(transport, light, blockers ? &geometry : nullptr, kSteps);
  const Comparison apart = compare_volumes(accumulated.read(session), expected.accumulated.values, n);
  const double allowed = options.lobe_time == LobeTime::kernel
                             ? tolerance("propagate-run-time-lobes")
                             : tolerance("propagate", options.format.storage);
  const std::string variant =
      fmt::format("{}/{}/{}/{}{}{}", basis.name(), name_of(transport.kind), name_of(options.state),
                  !blockers                               ? "free"
                  : transport.blocking == Blocking::areas ? "areas"
                                                          : "blockers",
                  transport.lobes.kind == LobeKind::rotate ? "/rotate" : "",
                  options.lobe_time == LobeTime::host     ? ""
                  : options.table == TableStorage::buffer ? "/kernel"
                                                          : "/kernel image") +
      (options.format == VolumeFormat{} ? "" : fmt::format("/{}", format_name(options.format)));
  return {"propagate", variant, apart.worst, allowed, apart.place};
}

/// `full`: tests every transport in both states, with and without blockers.
void check_constants(Session& session, const Basis& basis, const LobeOptions& lobes, bool full,
                     CheckResults& results) {
  for (const TransportKind kind : stepped_transports()) {
    if (!full && kind != TransportKind::sampled) continue;
    const Transport transport = make_transport(kind, basis, lobes);
    const auto add = [&](State state, bool blockers) {
      results.push_back(check_one(session, basis, transport, {.grid = kGrid, .state = state}, blockers));
    };
    // The first step never blocks, so a run with blockers tests both of its kernels. Fluxes differ: their first step is
    // a separate kernel.
    if (full) add(State::coefficients, true);
    add(State::fluxes, true);
    if (full) add(State::fluxes, false);
  }
}

/// Lobes computed in the kernel: exact and rotated ones, with the table as a buffer and as an image.
void check_run_time_lobes(Session& session, const Basis& basis, bool full, CheckResults& results) {
  const auto add = [&](TransportKind transport, LobeKind kind, TableStorage table) {
    if (table == TableStorage::image && !session.device().images) return;
    const LobeOptions lobes{.kind = kind, .table_functions = kind == LobeKind::rotate};
    results.push_back(check_one(session, basis, make_transport(transport, basis, lobes),
                                {.grid = kGrid, .lobe_time = LobeTime::kernel, .table = table}, true));
  };
  add(TransportKind::sampled, LobeKind::rotate, TableStorage::buffer);
  if (!full) return;
  add(TransportKind::exact, LobeKind::exact, TableStorage::buffer);
  add(TransportKind::exact, LobeKind::rotate, TableStorage::image);
}

/// Blockers as areas: tests the sets of links, since the basis has little effect.
void check_areas(Session& session, bool thorough, CheckResults& results) {
  for (const char* name : {"sh2", "bins24"}) {
    if (!thorough && std::string(name) != "sh2") continue;
    const std::unique_ptr<Basis> basis = make_basis(name);
    for (const TransportKind transport : stepped_transports()) {
      results.push_back(check_one(session, *basis, make_transport(transport, *basis, {}, Blocking::areas),
                                  {.grid = kGrid}, true));
    }
  }
}

/// Tests all other volume formats with one basis and transport, which do not affect them.
void check_formats(Session& session, const CheckScope& scope, CheckResults& results) {
  const std::unique_ptr<Basis> basis = make_basis("sh2");
  const Transport transport = make_transport(TransportKind::sampled, *basis);
  const VolumeShape corners{kFormatGrid + 1, basis->size(), 1};
  for (const VolumeFormat& format : other_formats(session.device(), corners, scope.formats)) {
    results.push_back(check_one(session, *basis, transport, {.grid = kFormatGrid, .format = format}, true));
  }
}

}  // namespace

CheckResults check_propagate(Session& session, const CheckScope& scope) {
  // Tests one orthogonal basis, one of antipodal centres and one of neither kind in full. Other bases and transports
  // are tested singly, not in pairs, since building kernels dominates the time.
  const std::set<std::string> in_full = {"sh2", "srbf8v2", "srbf4"};
  CheckResults results;
  for (const std::string& name : scope.bases) {
    const std::unique_ptr<Basis> basis = make_basis(name);
    const bool full = scope.thorough || in_full.count(name) > 0;
    check_constants(session, *basis, {}, full, results);
    // In full for the cheapest basis with a table; otherwise without and with a table, and where errors are largest.
    const std::set<std::string> lobes = {"sh2", "srbf4", "srbf8v2", "srbf14"};
    if (scope.thorough || lobes.count(name) > 0)
      check_run_time_lobes(session, *basis, scope.thorough || name == "srbf4", results);
    if (!basis->centres().empty() && scope.thorough) {
      check_constants(session, *basis, {.kind = LobeKind::rotate, .table_functions = true}, true, results);
    }
  }
  check_areas(session, scope.thorough, results);
  check_formats(session, scope, results);
  return results;
}

}  // namespace clpv::reference
