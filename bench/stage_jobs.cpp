// SPDX-License-Identifier: MIT
#include "bench/stage_jobs.hpp"

#include <fmt/format.h>

#include "basis/basis.hpp"

namespace clpv::bench {

Row make_row(const std::string& suite, std::string_view stage, const Variant& variant,
             const std::string& more) {
  const RenderOptions &o = variant.options, plain = timed_options();
  Row row;
  row.suite = suite;
  row.stage = stage;
  row.variant = variant;
  row.n = make_basis(o)->size();
  row.name = fmt::format("{}/{}/{}", stage, o.basis, format_name(o.format()));
  if (o.state != plain.state) row.name += fmt::format("/{}", name_of(o.state));
  if (lobes_of(o) != lobes_of(plain)) row.name += fmt::format("/{}", lobes_of(o));
  if (o.transport != plain.transport && stage != name_of(Stage::sweep))
    row.name += fmt::format("/{}", name_of(o.transport));
  if (o.occlusion) row.name += "/occlusion";
  if (variant.cascade) row.name += fmt::format("/cascade:{}", *variant.cascade);
  if (!variant.filtered) row.name += "/texels";
  row.name += more;
  return row;
}

Variant swept(Variant variant) {
  RenderOptions& o = variant.options;
  o.transport = TransportKind::sweep;
  o.blockers = Blockers::scene, o.blocking = Blocking::areas;
  return variant;
}

Case stage_case(Bench& bench, const std::string& suite, const StageJob& job, const Variant& given,
                const std::string& more) {
  const Variant variant = job.stage == Stage::sweep ? swept(given) : given;
  return {make_row(suite, job.name(), variant, more),
          [&bench, make = job.make, variant] { return make(bench, variant); }};
}

}  // namespace clpv::bench
