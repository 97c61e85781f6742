// SPDX-License-Identifier: MIT
#include "pipeline/steps/run_time_lobes.hpp"

#include <fmt/format.h>

#include <vector>

#include "basis/kernel_text.hpp"
#include "codegen/inject_source.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

const std::vector<Face>& faces_of(const Transport& transport) {
  if (const auto* scheme = std::get_if<FaceTransport>(&transport.scheme)) return scheme->faces;
  throw Error(ExitCode::usage, "lobe-time kernel: transport '{}' has no lobes; allowed: host",
              name_of(transport.kind));
}

cl_float4 packed(const glm::dvec3& v, double w) {
  const glm::vec4 narrow(v, w);
  return {{narrow.x, narrow.y, narrow.z, narrow.w}};
}

/// `functions_of_link(link)`: the basis functions along a link, times its solid angle.
std::string functions_source(const Basis& basis, const LobeOptions& lobes) {
  const bool looked_up = lobes.table_functions && !basis.centres().empty();
  std::string text = looked_up ? table_basis_source(basis, lobes.table_size, kFunctionsTable) : "";
  text += fmt::format(
      "CLPV_INLINE Coefficients functions_of_link(const float4 link CLPV_AND_FUNCTIONS) {{\n"
      "  Coefficients b = {};\n",
      looked_up ? "table_basis(link.x, link.y, link.z CLPV_PASS_FUNCTIONS)"
                : "basis_functions(link.x, link.y, link.z)");
  for (int i = 0; i < basis.size(); ++i) text += fmt::format("  b.c[{}] *= link.w;\n", i);
  return text + "  return b;\n}\n";
}

}  // namespace

RunTimeLobes::RunTimeLobes(Session& session, const Basis& basis, const Transport& transport,
                           TableStorage storage)
    : table_(session, basis, transport.lobes, storage, TableUse::lobes),
      functions_(session, basis, transport.lobes, storage, TableUse::functions),
      text_(lobe_source(basis, transport.lobes) + functions_source(basis, transport.lobes)),
      unit_flux_(transport.unit_flux_lobes),
      evaluates_(transport.kind == TransportKind::sampled) {
  std::vector<cl_float4> normals, links;
  for (const Face& face : faces_of(transport)) {
    normals.push_back(packed(glm::dvec3(face.normal), 0));
    links.push_back(packed(face.direction, face.solid_angle));
  }
  normals_ = session.upload(normals, "normals of faces");
  links_ = session.upload(links, "links through faces");
}

void RunTimeLobes::add_literals(Literals& literals) const {
  literals.flag("CLPV_LOBES_AT_RUN_TIME", true)
      .flag("CLPV_EVALUATE_AT_RUN_TIME", evaluates_)
      .flag("CLPV_UNIT_FLUX", unit_flux_);
}

void RunTimeLobes::add_to(Kernel& step) const {
  step.add(normals_, links_);
  table_.add_to(step);
  functions_.add_to(step);
}

}  // namespace clpv
