// SPDX-License-Identifier: MIT
#include "pipeline/steps/run_time_lobes.hpp"

#include <vector>

#include "pipeline/inject/lookup_table.hpp"
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

}  // namespace

RunTimeLobes::RunTimeLobes(Session& session, const Basis& basis, const Transport& transport,
                           TableStorage storage)
    : table_(session, basis, transport.lobes, storage, TableUse::lobes),
      functions_(session, basis, transport.lobes, storage, TableUse::functions),
      literals_(lobe_literals(basis, transport.lobes)) {
  // Integrals over faces are constants.
  literals_.flag("CLPV_EVALUATE_AT_RUN_TIME", transport.kind == TransportKind::sampled)
      .flag("CLPV_UNIT_FLUX", transport.unit_flux_lobes)
      .flag("CLPV_FROM_TABLE", functions_.exists());
  (table_.exists() ? table_ : functions_).add_literals(literals_);
  std::vector<cl_float4> normals, links;
  for (const Face& face : faces_of(transport)) {
    normals.push_back(packed(glm::dvec3(face.normal), 0));
    links.push_back(packed(face.direction, face.solid_angle));
  }
  normals_ = session.upload(normals, "normals of faces");
  links_ = session.upload(links, "links through faces");
}

void RunTimeLobes::add_to(Kernel& step) const {
  step.add(normals_, links_);
  table_.add_to(step);
  functions_.add_to(step);
}

}  // namespace clpv
