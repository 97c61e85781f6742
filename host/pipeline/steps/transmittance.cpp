// SPDX-License-Identifier: MIT
#include "pipeline/steps/transmittance.hpp"

#include <vector>

namespace clpv {
namespace {

/// A link into a cell: the side of the cell that it passes, and weights of the blockers there.
struct Link {
  glm::ivec3 side;
  std::vector<double> blocked_by;

  /// Corners of the cell on that side.
  int corners() const { return 1 << ((side.x == 0) + (side.y == 0) + (side.z == 0)); }
};

/// The 30 links to faces, or one link to each neighbour through the face, edge or corner that the
/// cells share.
std::vector<Link> links_of(const Transport& transport) {
  std::vector<Link> links;
  if (const auto* scheme = std::get_if<FaceTransport>(&transport.scheme)) {
    for (const Face& face : scheme->faces) links.push_back({face.normal, face.blocked_by});
  } else {
    for (const SweepLink& link : std::get<std::vector<SweepLink>>(transport.scheme))
      links.push_back({-link.offset, link.blocked_by});
  }
  return links;
}

}  // namespace

LinkConstants link_constants(const Basis& basis, const Transport& transport) {
  const std::vector<Link> links = links_of(transport);
  const int count = static_cast<int>(links.size());
  Matrix weights(count, blocking_size(transport.blocking, basis));
  std::vector<int> sides;
  LinkConstants result;
  for (int l = 0; l < count; ++l) {
    for (int axis = 0; axis < 3; ++axis) sides.push_back(links[l].side[axis]);
    for (int i = 0; i < weights.columns(); ++i) {
      weights(l, i) = links[l].blocked_by[i] / links[l].corners();
    }
  }
  result.links = count;
  add_coefficient_literals(result.literals, weights.columns());
  result.literals.integer("CLPV_LINKS", count)
      .integers("CLPV_LINK_SIDES", sides)
      .matrix("CLPV_LINK_BLOCKED", weights);
  return result;
}

LinkTransmittance::LinkTransmittance(Session& session, const Basis& basis,
                                     const Transport& transport, int grid,
                                     const VolumeFormat& format)
    : LinkTransmittance(session, link_constants(basis, transport), grid, format) {}

LinkTransmittance::LinkTransmittance(Session& session, const LinkConstants& constants, int grid,
                                     const VolumeFormat& format)
    : stencil_(grid, format, lanes_of(session.device(), format)),
      kernel_(session, {"steps/transmittance.cl", stencil_.literals().add(constants.literals)},
              "transmit"),
      transmittance_(session, {grid, constants.links, 1}, "transmittance", format) {}

void LinkTransmittance::transmit(const Volume& geometry) {
  kernel_.set(geometry.memory(), transmittance_.memory());
  stencil_.launch(kernel_, 1);
}

}  // namespace clpv
