// SPDX-License-Identifier: MIT
// Propagation: kernels against CPU reference on a small grid of random light and random blockers.
#include "pipeline/steps/propagate.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <string_view>

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

/// One comparison: a basis, its transport, and options of the kernels.
struct PropagateCase {
  TransportKind kind;
  LobeOptions lobes = {};
  Blocking blocking = Blocking::one_sided;
  PropagateOptions options = {};
  bool blockers = true;

  std::string name(const Basis& basis) const {
    return fmt::format("{}/{}/{}/{}{}{}", basis.name(), name_of(kind), name_of(options.state),
                       !blockers                     ? "free"
                       : blocking == Blocking::areas ? "areas"
                                                     : "blockers",
                       lobes.kind == LobeKind::rotate ? "/rotate" : "",
                       options.lobe_time == LobeTime::host     ? ""
                       : options.table == TableStorage::buffer ? "/kernel"
                                                               : "/kernel image") +
           (options.format == VolumeFormat{} ? "" : fmt::format("/{}", format_name(options.format)));
  }
};

CheckResult check_one(Session& session, const Basis& basis, const PropagateCase& c) {
  const PropagateOptions& options = c.options;
  const Transport transport = make_transport(c.kind, basis, c.lobes, c.blocking);
  std::mt19937 random(7);
  const int n = options.grid;
  const Volume light = random_light(basis, n, random);
  const Volume geometry = random_blockers(blocking_size(transport.blocking, basis), n, random);
  const clpv::Volume injected = on_device(session, light, options.format),
                     corners = on_device(session, geometry, options.format);
  clpv::Volume accumulated(session, {n, basis.size(), 3}, "check: accumulated light", options.format);
  Propagator propagator(session, basis, transport, options);
  propagator.propagate({injected, c.blockers ? &corners : nullptr, accumulated}, kSteps);
  const Propagation expected = propagate(transport, light, c.blockers ? &geometry : nullptr, kSteps);
  const Comparison apart = compare_volumes(accumulated.read(session), expected.accumulated.values, n);
  const double allowed = options.lobe_time == LobeTime::kernel
                             ? tolerance("propagate-run-time-lobes")
                             : tolerance("propagate", options.format.storage);
  return {"propagate", c.name(basis), apart.worst, allowed, apart.place};
}

/// Runs the comparison if the scope selects it.
using Add = std::function<void(const Basis&, const PropagateCase&)>;

/// A basis and its kernels, with lobes as constants.
struct ConstantsCase {
  std::string_view basis;
  TransportKind kind;
  State state;
  bool blockers = true;
};

/// Each path of the generated code once. The first step never blocks, so a run with blockers tests both of its kernels.
/// Fluxes differ: their first step is a separate kernel.
constexpr ConstantsCase kConstants[] = {
    {"sh2", TransportKind::sampled, State::coefficients},
    {"sh2", TransportKind::exact, State::fluxes},
    {"sh2", TransportKind::exact, State::fluxes, false},
    {"srbf4", TransportKind::sampled, State::coefficients},  // few mirrors
    {"srbf4", TransportKind::exact, State::fluxes},
    {"srbf8v2", TransportKind::sampled, State::coefficients},  // pairs of opposite centres
    {"bins24", TransportKind::sampled, State::fluxes},
};

void check_constants(const Basis& basis, const LobeOptions& lobes, bool thorough, const Add& compare) {
  const auto add = [&](TransportKind kind, State state, bool blockers) {
    compare(basis,
            {.kind = kind, .lobes = lobes, .options = {.grid = kGrid, .state = state}, .blockers = blockers});
  };
  for (const ConstantsCase& c : kConstants) {
    if (!thorough && c.basis == basis.name()) add(c.kind, c.state, c.blockers);
  }
  if (!thorough) return;
  for (const TransportKind kind : stepped_transports()) {
    add(kind, State::coefficients, true);
    add(kind, State::fluxes, true);
    add(kind, State::fluxes, false);
  }
}

/// Lobes computed in the kernel: exact and rotated ones, with the table as a buffer and as an image.
void check_run_time_lobes(const Device& device, const Basis& basis, bool full, const Add& compare) {
  const auto add = [&](TransportKind transport, LobeKind kind, TableStorage table) {
    if (table == TableStorage::image && !device.images) return;
    compare(basis, {.kind = transport,
                    .lobes = {.kind = kind, .table_functions = kind == LobeKind::rotate},
                    .options = {.grid = kGrid, .lobe_time = LobeTime::kernel, .table = table}});
  };
  add(TransportKind::sampled, LobeKind::rotate, TableStorage::buffer);
  if (!full) return;
  add(TransportKind::exact, LobeKind::exact, TableStorage::buffer);
  add(TransportKind::exact, LobeKind::rotate, TableStorage::image);
}

/// Blockers as areas: tests the sets of links, since the basis has little effect.
void check_areas(bool thorough, const Add& compare) {
  for (const char* name : {"sh2", "bins24"}) {
    if (!thorough && std::string(name) != "sh2") continue;
    const std::unique_ptr<Basis> basis = make_basis(name);
    for (const TransportKind transport : stepped_transports()) {
      compare(*basis, {.kind = transport, .blocking = Blocking::areas, .options = {.grid = kGrid}});
    }
  }
}

/// Tests all other volume formats with one basis and transport, which do not affect them.
void check_formats(const Device& device, const CheckScope& scope, const Add& compare) {
  const std::unique_ptr<Basis> basis = make_basis("sh2");
  const VolumeShape corners{kFormatGrid + 1, basis->size(), 1};
  for (const VolumeFormat& format : other_formats(device, corners, scope.formats)) {
    compare(*basis, {.kind = TransportKind::sampled, .options = {.grid = kFormatGrid, .format = format}});
  }
}

}  // namespace

CheckResults check_propagate(Session& session, const CheckScope& scope) {
  CheckResults results;
  const Add compare = [&](const Basis& basis, const PropagateCase& c) {
    compare_selected(scope, "propagate", c.name(basis), results,
                     [&] { return check_one(session, basis, c); });
  };
  for (const std::string& name : scope.bases) {
    const std::unique_ptr<Basis> basis = make_basis(name);
    const bool centred = !basis->centres().empty();
    check_constants(*basis, {}, scope.thorough, compare);
    // Only the small bases, without and with a table.
    if (scope.thorough || basis->size() == 4)
      check_run_time_lobes(session.device(), *basis, scope.thorough || centred, compare);
    if (centred && scope.thorough) {
      check_constants(*basis, {.kind = LobeKind::rotate, .table_functions = true}, true, compare);
    }
  }
  check_areas(scope.thorough, compare);
  check_formats(session.device(), scope, compare);
  return results;
}

}  // namespace clpv::reference
