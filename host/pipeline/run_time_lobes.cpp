#include "pipeline/run_time_lobes.hpp"

#include <vector>

#include "codegen/inject_source.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

std::vector<cl_float4> normals_of(const Transport& transport) {
  const auto* scheme = std::get_if<FaceTransport>(&transport.scheme);
  if (scheme == nullptr) {
    throw Error(ExitCode::usage, "lobe-time kernel: transport '{}' has no lobes; allowed: host",
                name_of(transport.kind));
  }
  std::vector<cl_float4> normals;
  for (const Face& face : scheme->faces) {
    const glm::vec3 n(face.normal);
    normals.push_back({{n.x, n.y, n.z, 0}});
  }
  return normals;
}

}  // namespace

RunTimeLobes::RunTimeLobes(Session& session, const Basis& basis, const Transport& transport, State state,
                           TableStorage storage)
    : table_(session, basis, transport.lobes, storage, TableUse::lobes),
      text_(lobe_source(basis, transport.lobes, false)),
      unit_flux_(transport.unit_flux_lobes) {
  if (state == State::fluxes) {
    throw Error(ExitCode::usage,
                "lobe-time kernel: with state fluxes no step makes lobes; allowed: host, or coefficients");
  }
  const std::vector<cl_float4> normals = normals_of(transport);
  faces_ = normals.size();
  normals_ = session.upload(normals, "normals of faces");
}

void RunTimeLobes::add_literals(Literals& literals) const {
  literals.flag("CLPV_LOBES_AT_RUN_TIME", true)
      .integer("CLPV_FACES", faces_)
      .flag("CLPV_UNIT_FLUX", unit_flux_);
}

void RunTimeLobes::add_to(Kernel& step) const {
  step.add(normals_);
  table_.add_to(step);
}

}  // namespace clpv
