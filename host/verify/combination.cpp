// SPDX-License-Identifier: MIT
// Comparisons of the kernels that a frame with given options runs, in that combination.
#include <fmt/format.h>

#include "basis/sweep.hpp"
#include "options/render_options.hpp"
#include "options/stage_options.hpp"
#include "verify/check.hpp"
#include "verify/gather.hpp"
#include "verify/inject.hpp"
#include "verify/propagate.hpp"
#include "verify/sweep.hpp"

namespace clpv::verify {
namespace {

constexpr int kGrid = 9;  // small; no multiple of a work-group

Job inject_job_of(Session& session, const RenderOptions& o, bool light) {
  const std::shared_ptr<const Basis> basis = make_basis(o);
  const bool unit_flux = make_transport(o, *basis).unit_flux_lobes;
  InjectProblem problem =
      random_injection(session, basis, inject_options(o, unit_flux), light, true, o.rsm_format);
  problem.stride = o.blocker_stride;
  return inject_job(session, problem);
}

Job propagate_job_of(Session& session, const RenderOptions& o) {
  const std::shared_ptr<const Basis> basis = make_basis(o);
  const Transport transport = make_transport(o, *basis);
  return has_faces(o.transport)
             ? propagate_job(
                   session, random_propagation(basis, transport, propagate_options(o), o.blocked()))
             : sweep_job(session, random_sweep(basis, transport, sweep_options(o)));
}

Job gather_job_of(Session& session, const RenderOptions& o) {
  const std::shared_ptr<const Basis> basis = has_faces(o.transport) ? make_basis(o) : swept_basis();
  return gather_job(session, random_gathering(session, basis, o.transport, gather_options(o)));
}

}  // namespace

Cases cases_of(const RenderOptions& options) {
  RenderOptions o = options;
  o.grid = kGrid;
  const std::string name =
      fmt::format("{}/{}/{}", name_of(o.preset), o.basis, format_name(o.format()));
  Cases cases = {job_case(Stage::inject, name + "/light",
                          [o](Session& session) { return inject_job_of(session, o, true); })};
  if (o.blockers == Blockers::seen)
    cases.push_back(job_case(Stage::inject, name + "/geometry",
                             [o](Session& session) { return inject_job_of(session, o, false); }));
  const Stage propagation = has_faces(o.transport) ? Stage::propagate
                            : !o.reflects()        ? Stage::sweep
                                                   : Stage::bounce;
  cases.push_back(
      job_case(propagation, name, [o](Session& session) { return propagate_job_of(session, o); }));
  cases.push_back(
      job_case(Stage::gather, name, [o](Session& session) { return gather_job_of(session, o); }));
  return cases;
}

}  // namespace clpv::verify
