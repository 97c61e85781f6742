#include "bench/stage_jobs.hpp"

#include <fmt/format.h>

#include <cmath>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "support/error.hpp"

namespace clpv::bench {

Row make_row(const std::string& suite, const std::string& stage, const Variant& variant,
             const std::string& more) {
  Row row;
  row.suite = suite;
  row.stage = stage;
  row.variant = variant;
  row.n = make_basis(variant.basis, variant.lambda)->size();
  row.name = fmt::format("{}/{}/{}/{}", stage, variant.basis, variant.layout, variant.storage);
  const Variant plain;
  for (const auto& [value, usual] : {std::pair{variant.state, plain.state},
                                     {variant.lobe, plain.lobe},
                                     {variant.transport, plain.transport}}) {
    if (value != usual) row.name += "/" + value;
  }
  if (variant.occlusion) row.name += "/occlusion";
  if (variant.cascade) row.name += fmt::format("/cascade:{}", *variant.cascade);
  if (!variant.filtered) row.name += "/texels";
  row.name += more;
  return row;
}

VolumeFormat format_of(const Variant& variant) {
  return volume_format(variant.layout, variant.storage);
}

LobeOptions lobe_options(const Variant& variant) {
  LobeOptions options;
  options.kind = variant.lobe == "exact" ? LobeKind::exact : LobeKind::rotate;
  return options;
}

State state_of(const Variant& variant) {
  return variant.state == "fluxes" ? State::fluxes : State::coefficients;
}

Case stage_case(Bench& bench, const std::string& suite, const std::string& stage, const Variant& variant,
                const std::string& more) {
  Job (*make)(Bench&, const Variant&) = stage == "inject"      ? inject_job
                                        : stage == "propagate" ? propagate_job
                                                               : gather_job;
  return {make_row(suite, stage, variant, more), [&bench, make, variant] { return make(bench, variant); }};
}

}  // namespace clpv::bench
