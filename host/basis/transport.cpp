// SPDX-License-Identifier: MIT
#include "basis/transport.hpp"

#include "basis/face_transport.hpp"
#include "basis/sweep.hpp"
#include "support/named_enum.hpp"

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
  for (SweepWay& way : std::get<std::vector<SweepWay>>(transport.scheme))
    way.blocked_by = weights(way.direction);
}

}  // namespace

std::vector<TransportKind> stepped_transports() {
  std::vector<TransportKind> stepped;
  for (const TransportKind kind : values_of<TransportKind>()) {
    if (kind != TransportKind::sweep) stepped.push_back(kind);
  }
  return stepped;
}

Transport make_transport(TransportKind kind, const Basis& basis, const LobeOptions& lobes,
                         Blocking blocking) {
  Transport transport;
  transport.kind = kind;
  transport.lobes = lobes;
  transport.blocking = blocking;
  switch (kind) {
    case TransportKind::sampled:
      transport.scheme = make_face_transport(basis, FaceFlux::sampled, lobes);
      break;
    case TransportKind::exact:
      transport.scheme = make_face_transport(basis, FaceFlux::exact, lobes);
      transport.unit_flux_lobes = true;
      break;
    case TransportKind::sweep:
      transport.scheme = sweep_ways();
      break;
  }
  look_up_blockers(transport, basis);
  return transport;
}

}  // namespace clpv
