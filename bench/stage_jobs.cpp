// SPDX-License-Identifier: MIT
// Names of rows and cases of the pipeline's stages.
#include "bench/stage_jobs.hpp"

#include <fmt/format.h>

#include "basis/basis.hpp"

namespace clpv::bench {

Row make_row(const std::string& suite, std::string_view stage, const Variant& variant,
             const std::string& suffix) {
  const RenderOptions &o = variant.options, usual = timed_options();
  Row row;
  row.suite = suite;
  row.stage = stage;
  row.variant = variant;
  row.n = make_basis(o)->size();
  row.name = fmt::format("{}/{}/{}", stage, o.basis, format_name(o.format()));
  if (o.state != usual.state) row.name += fmt::format("/{}", name_of(o.state));
  if (lobes_of(o) != lobes_of(usual)) row.name += fmt::format("/{}", lobes_of(o));
  if (o.transport != usual.transport && stage != name_of(Stage::sweep))
    row.name += fmt::format("/{}", name_of(o.transport));
  if (o.blocked()) row.name += "/occlusion";
  if (variant.cascade) row.name += fmt::format("/cascade:{}", *variant.cascade);
  if (!variant.filtered) row.name += "/texels";
  row.name += suffix;
  return row;
}

Variant with_sweep(Variant variant) {
  RenderOptions& o = variant.options;
  o.transport = TransportKind::sweep;
  if (o.blocked()) o.blockers = Blockers::scene;
  o.blocking = Blocking::areas;
  return variant;
}

Case stage_case(Bench& bench, const std::string& suite, const StageJob& job, const Variant& variant) {
  const Variant timed = job.stage == Stage::sweep ? with_sweep(variant) : variant;
  return {make_row(suite, job.name(), timed),
          [&bench, make = job.make, timed] { return make(bench, timed); }};
}

}  // namespace clpv::bench
