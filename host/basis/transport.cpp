#include "basis/transport.hpp"

#include <fmt/ranges.h>

#include "basis/face_transport.hpp"
#include "basis/operator_transport.hpp"
#include "support/error.hpp"

namespace clpv {

const std::array<glm::ivec3, 6> kAxes{glm::ivec3(1, 0, 0),  glm::ivec3(-1, 0, 0), glm::ivec3(0, 1, 0),
                                      glm::ivec3(0, -1, 0), glm::ivec3(0, 0, 1),  glm::ivec3(0, 0, -1)};

namespace {

void look_up_blockers(Transport& transport, const Basis& basis) {
  const auto weights = [&](const glm::dvec3& direction) {
    return blocking_weights(transport.blocking, basis, transport.lobes, direction);
  };
  if (auto* faces = std::get_if<FaceTransport>(&transport.scheme)) {
    for (Face& face : faces->faces) face.blocked_by = weights(face.direction);
    return;
  }
  for (auto& neighbour : std::get<OperatorTransport>(transport.scheme).neighbours) {
    if (neighbour.offset != glm::ivec3(0)) neighbour.blocked_by = weights(neighbour.direction);
  }
}

}  // namespace

std::vector<std::string> transport_names() {
  return {"sampled", "exact", "upwind", "semi-lagrangian"};
}

Transport make_transport(const std::string& name, const Basis& basis, const LobeOptions& lobes,
                         Blocking blocking) {
  Transport transport;
  transport.name = name;
  transport.lobes = lobes;
  transport.blocking = blocking;
  transport.gather = Matrix::identity(basis.size());
  if (name == "sampled") {
    transport.scheme = make_face_transport(basis, FaceFlux::sampled, lobes);
  } else if (name == "exact") {
    transport.scheme = make_face_transport(basis, FaceFlux::exact, lobes);
    transport.unit_flux_lobes = true;
  } else if (name == "upwind") {
    transport.scheme = make_upwind(basis, transport.gather);
    transport.gathers_cosine = true;
  } else if (name == "semi-lagrangian") {
    transport.scheme = make_semi_lagrangian(basis);
    transport.gathers_cosine = true;
  } else {
    throw Error(ExitCode::usage, "there is no transport '{}'; there are {}", name,
                fmt::join(transport_names(), ", "));
  }
  look_up_blockers(transport, basis);
  return transport;
}

}  // namespace clpv
