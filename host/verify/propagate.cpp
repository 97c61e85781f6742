// SPDX-License-Identifier: MIT
// Propagation: kernels against CPU reference. Checks use a small grid of random light and random
// blockers.
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
#include "verify/jobs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::verify {
namespace {

constexpr int kStepsGrid = 7;  // no multiple of a work-group: tests borders and partial work-groups
constexpr int kFormatGrid = 17;  // whole blocks of 8 cells plus one cell
constexpr int kSteps = 5;        // light crosses the grid and meets blockers

/// Volumes and kernels of one propagation.
struct PropagateWork {
  PropagateProblem problem;
  Volume injected, accumulated;
  std::optional<Volume> geometry;
  Propagator propagator;

  PropagateWork(Session& session, const PropagateProblem& p)
      : problem(p),
        injected(on_device(session, *p.light, p.options.format)),
        accumulated(session, injected.shape(), "accumulated light", p.options.format),
        propagator(session, *p.basis, problem.transport, p.options) {
    if (p.geometry) geometry.emplace(on_device(session, *p.geometry, p.options.format));
  }
  void run(int steps) {
    propagator.propagate({injected, geometry ? &*geometry : nullptr, accumulated}, steps);
  }
};

/// One case: a basis, its transport, and options of the kernels.
struct PropagateCase {
  TransportKind kind;
  LobeOptions lobes = {};
  Blocking blocking = Blocking::one_sided;
  PropagateOptions options = {};
  bool blockers = true;

  std::string name(const std::string& basis) const {
    return fmt::format("{}/{}/{}{}{}", basis, name_of(kind),
                       !blockers                     ? "free"
                       : blocking == Blocking::areas ? "areas"
                                                     : "blockers",
                       lobes.kind == LobeKind::rotate ? "/rotate" : "",
                       options.lobe_time == LobeTime::host     ? ""
                       : options.table == TableStorage::buffer ? "/kernel"
                                                               : "/kernel image") +
           (options.format == VolumeFormat{} ? ""
                                             : fmt::format("/{}", format_name(options.format)));
  }
};

/// Adds a case of the basis of that name.
using Add = std::function<void(const std::string&, const PropagateCase&)>;

/// A basis and its kernels, with lobes as constants.
struct ConstantsCase {
  std::string_view basis;
  TransportKind kind;
  bool blockers = true;
};

/// Few and many coefficients, matrices with and without zeros. A run with blockers also tests a
/// step that is not blocked.
constexpr ConstantsCase kConstants[] = {
    {"sh2", TransportKind::sampled},    {"sh2", TransportKind::exact, false},
    {"srbf4", TransportKind::exact},    {"srbf8v2", TransportKind::sampled},
    {"bins24", TransportKind::sampled},
};

void add_constants(const std::string& basis, const LobeOptions& lobes, bool thorough,
                   const Add& add_case) {
  const auto add = [&](TransportKind kind, bool blockers) {
    add_case(basis,
             {.kind = kind, .lobes = lobes, .options = {.grid = kStepsGrid}, .blockers = blockers});
  };
  for (const ConstantsCase& c : kConstants) {
    if (!thorough && c.basis == basis) add(c.kind, c.blockers);
  }
  if (!thorough) return;
  for (const TransportKind kind : stepped_transports()) {
    add(kind, true);
    add(kind, false);
  }
}

/// Lobes computed in the kernel: exact and rotated ones, with the table as a buffer and as an
/// image.
void add_run_time_lobes(const std::string& basis, bool full, const Add& add_case) {
  const auto add = [&](TransportKind transport, LobeKind kind, TableStorage table) {
    add_case(basis,
             {.kind = transport,
              .lobes = {.kind = kind, .table_functions = kind == LobeKind::rotate},
              .options = {.grid = kStepsGrid, .lobe_time = LobeTime::kernel, .table = table}});
  };
  add(TransportKind::sampled, LobeKind::rotate, TableStorage::buffer);
  if (!full) return;
  add(TransportKind::exact, LobeKind::exact, TableStorage::buffer);
  add(TransportKind::exact, LobeKind::rotate, TableStorage::image);
}

}  // namespace

Job propagate_job(Session& session, const PropagateProblem& problem, const Share& share) {
  const auto p = std::make_shared<PropagateWork>(session, problem);
  Job job;
  job.reset = [p, &session] { p->accumulated.clear(session); };
  job.run = [p] { p->run(p->problem.steps); };
  job.compare = [p, &session, share] {
    const PropagateProblem& q = p->problem;
    const Values expected = share([&] {
      return reference::propagate(q.transport, *q.light, q.geometry.get(), q.steps)
          .accumulated.values;
    });
    // In half-floats, the rounding of storage is larger than that of lobes rotated at run time.
    const Storage storage = q.options.format.storage;
    const bool at_run_time = q.options.lobe_time == LobeTime::kernel && storage == Storage::float32;
    const double allowed =
        tolerance(at_run_time ? "propagate-run-time-lobes" : "propagate", storage);
    expect(session, p->accumulated, ranges_about(*expected, allowed));
    return compare_volumes(p->accumulated.read(session), *expected, q.options.grid, allowed);
  };
  return job;
}

PropagateProblem random_propagation(const std::shared_ptr<const Basis>& basis,
                                    const Transport& transport, const PropagateOptions& options,
                                    bool blocked) {
  std::mt19937 random(7);
  PropagateProblem problem{
      basis, transport, options, kSteps, random_light(*basis, options.grid, random), {}};
  if (blocked)
    problem.geometry =
        random_blockers(blocking_size(transport.blocking, *basis), options.grid, random);
  return problem;
}

Cases propagate_cases(const CheckScope& scope) {
  Cases cases;
  const Add add = [&](const std::string& name, const PropagateCase& c) {
    cases.push_back(job_case(Stage::propagate, c.name(name), [name, c](Session& session) {
      const std::shared_ptr<const Basis> basis = make_basis(name);
      return propagate_job(
          session, random_propagation(basis, make_transport(c.kind, *basis, c.lobes, c.blocking),
                                      c.options, c.blockers));
    }));
  };
  for (const std::string& name : scope.bases) {
    const std::unique_ptr<Basis> basis = make_basis(name);
    const bool centred = !basis->centres().empty();
    add_constants(name, {}, scope.thorough, add);
    // Only the small bases, without and with a table.
    if (scope.thorough || basis->size() == 4)
      add_run_time_lobes(name, scope.thorough || centred, add);
    if (centred && scope.thorough)
      add_constants(name, {.kind = LobeKind::rotate, .table_functions = true}, true, add);
  }
  // Blockers as areas test the sets of links; the basis has little effect.
  for (const char* name : {"sh2", "bins24"}) {
    if (!scope.thorough && std::string(name) != "sh2") continue;
    for (const TransportKind transport : stepped_transports())
      add(name, {.kind = transport, .blocking = Blocking::areas, .options = {.grid = kStepsGrid}});
  }
  // Basis and transport do not affect formats.
  for (const VolumeFormat& format : scope.formats)
    add("sh2",
        {.kind = TransportKind::sampled, .options = {.grid = kFormatGrid, .format = format}});
  return cases;
}

}  // namespace clpv::verify
