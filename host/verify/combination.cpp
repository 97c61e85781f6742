// SPDX-License-Identifier: MIT
// Comparisons of the kernels that a frame with given options runs, in that combination.

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <iterator>

#include "basis/sweep.hpp"
#include "device/kernel.hpp"
#include "kernels/shared/emit.h"
#include "kernels/shared/fields.h"
#include "kernels/shared/grid.h"
#include "kernels/shared/light.h"
#include "kernels/shared/mesh.h"
#include "kernels/shared/raster.h"
#include "kernels/shared/region.h"
#include "kernels/shared/sweep.h"
#include "kernels/shared/view.h"
#include "kernels/shared/view_injection.h"
#include "kernels/shared/view_light.h"
#include "options/render_options.hpp"
#include "options/stage_options.hpp"
#include "verify/check.hpp"
#include "verify/inputs.hpp"
#include "verify/jobs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::verify {

namespace {

constexpr int kGrid = 9;  // small; no multiple of a work-group

Job inject_job_of(Session& session, const RenderOptions& o, bool light) {
  const std::shared_ptr<const Basis> basis = make_basis(o);
  const bool unit_flux = make_transport(o, *basis).unit_flux_lobes;
  const bool sees = light && !has_faces(o.transport) && o.gather == Gathering::visible;
  InjectProblem problem = random_injection(session, basis, inject_options(o, unit_flux), light,
                                           true, o.rsm_format, false, sees);
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

// Compares the device's layout of the shared structs with the host's; a mismatch would corrupt
// every stage's input.

struct Place {
  const char* name;
  std::uint32_t bytes;
};

constexpr Place kHost[] = {
#define CLPV_FIELD(type, field) \
  {"size of " #type, sizeof(type)}, {#type "." #field, offsetof(type, field)},
    CLPV_EACH_SHARED(CLPV_FIELD)
#undef CLPV_FIELD
};

Deviation compare_sizes(Session& session) {
  const std::size_t count = std::size(kHost);
  Buffer bytes = session.buffer(count * sizeof(std::uint32_t), "sizes of the shared structs");
  Kernel(session, {"sizes.cl"}, "sizes").set(bytes).launch(cl::NDRange(1), cl::NDRange(1));
  const auto device = session.read<std::uint32_t>(bytes, count);

  Ranges ranges;
  for (const Place& place : kHost) ranges.push_back({double(place.bytes), double(place.bytes)});
  expect(session, bytes, "uint", ranges);
  Deviation result{0, tolerance("sizes")};
  for (std::size_t i = 0; i < count; ++i) {
    const double error =
        device[i] > kHost[i].bytes ? device[i] - kHost[i].bytes : kHost[i].bytes - device[i];
    result.take(error, [&] {
      return fmt::format("{}: {} bytes, host {}", kHost[i].name, device[i], kHost[i].bytes);
    });
  }
  return result;
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

Cases sizes_cases(const CheckScope&) {
  return {deviation_case(Stage::sizes, "shared structs", compare_sizes)};
}

}  // namespace clpv::verify
