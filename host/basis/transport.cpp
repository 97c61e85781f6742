// SPDX-License-Identifier: MIT
#include "basis/transport.hpp"

#include <cmath>
#include <numbers>

#include "basis/quadrature.hpp"
#include "basis/sweep.hpp"
#include "support/named_enum.hpp"

namespace clpv {

bool blocks_by_lobes(Blocking blocking) {
  switch (blocking) {
    case Blocking::areas:
      return false;
    case Blocking::one_sided:
      return true;
  }
  return true;
}

int blocking_size(Blocking blocking, const Basis& basis) {
  switch (blocking) {
    case Blocking::areas:
      return 3;
    case Blocking::one_sided:
      break;
  }
  return basis.size();
}

std::vector<double> blocking_weights(Blocking blocking, const Basis& basis,
                                     const LobeOptions& lobes, const glm::dvec3& direction) {
  switch (blocking) {
    case Blocking::areas:
      return {std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)};
    case Blocking::one_sided:
      break;
  }
  return evaluate(basis, lobes, -direction);
}

namespace {

using std::numbers::pi;

Face face_of(const glm::ivec3& travel, const glm::ivec3& normal) {
  const bool far = travel == normal;
  Face face{travel, normal, {}, far ? far_solid_angle() : side_solid_angle(), {}, {}};
  // Centre of the face: 3/2 k, or k + a/2.
  face.direction = glm::normalize(far ? glm::dvec3(travel) : glm::dvec3(2 * travel + normal));
  return face;
}

// Spherical polygon of the face from the source's centre; cells have edge 1, the neighbour's centre
// is `travel`.
SphericalPolygon cone_of(const Face& face) {
  const glm::dvec3 centre = glm::dvec3(face.travel) + 0.5 * glm::dvec3(face.normal);
  const glm::dvec3 u(face.normal.y, face.normal.z, face.normal.x),
      v(face.normal.z, face.normal.x, face.normal.y);
  SphericalPolygon corners;
  for (const auto& [s, t] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
    corners.push_back(glm::normalize(centre + 0.5 * (s * u + t * v)));
  }
  return corners;
}

std::vector<double> integral_over(const Basis& basis, const SphericalPolygon& cone) {
  std::vector<double> sum(static_cast<std::size_t>(basis.size()), 0.0), b(sum.size());
  for (const QuadratureNode& node : quadrature(basis, {cone})) {
    basis.evaluate(node.w, b);
    for (std::size_t i = 0; i < b.size(); ++i) sum[i] += node.weight * b[i];
  }
  return sum;
}

std::vector<double> sample_of(const Basis& basis, const LobeOptions& lobes, const Face& face) {
  std::vector<double> b = evaluate(basis, lobes, face.direction);
  for (double& value : b) value *= face.solid_angle;
  return b;
}

void set_blocking_weights(Transport& transport, const Basis& basis) {
  const auto weights = [&](const glm::dvec3& direction) {
    return blocking_weights(transport.blocking, basis, transport.lobes, direction);
  };
  if (auto* faces = std::get_if<FaceTransport>(&transport.scheme)) {
    for (Face& face : faces->faces) face.blocked_by = weights(face.direction);
    return;
  }
  for (SweepLink& link : std::get<std::vector<SweepLink>>(transport.scheme))
    link.blocked_by = weights(link.direction);
}

}  // namespace

const std::array<glm::ivec3, 6> kAxes{glm::ivec3(1, 0, 0), glm::ivec3(-1, 0, 0),
                                      glm::ivec3(0, 1, 0), glm::ivec3(0, -1, 0),
                                      glm::ivec3(0, 0, 1), glm::ivec3(0, 0, -1)};

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
      transport.scheme = sweep_links();
      break;
  }
  set_blocking_weights(transport, basis);
  return transport;
}

// 4 atan(1 / (6 sqrt(11/4))) = 4 asin(1/10).
double far_solid_angle() {
  return 4 * std::asin(0.1);
}
double side_solid_angle() {
  return (4 * pi / 6 - far_solid_angle()) / 4;
}

FaceTransport make_face_transport(const Basis& basis, FaceFlux flux, const LobeOptions& lobes) {
  FaceTransport transport;
  for (const glm::ivec3& travel : kAxes) {
    transport.faces.push_back(face_of(travel, travel));
    for (const glm::ivec3& normal : kAxes) {
      if (normal != travel && normal != -travel) transport.faces.push_back(face_of(travel, normal));
    }
  }
  for (Face& face : transport.faces) {
    face.flux = flux == FaceFlux::exact ? integral_over(basis, cone_of(face))
                                        : sample_of(basis, lobes, face);
  }
  const Lobes lobe_about(basis, lobes);
  transport.lobes = Matrix(basis.size(), static_cast<int>(kAxes.size()));
  for (std::size_t a = 0; a < kAxes.size(); ++a) {
    const std::vector<double> lobe = lobe_about(glm::dvec3(kAxes[a]));
    const double carried = flux == FaceFlux::exact ? basis.energy(lobe) : pi;
    for (int i = 0; i < basis.size(); ++i) {
      transport.lobes(i, static_cast<int>(a)) = lobe[i] / carried;
    }
  }
  return transport;
}

}  // namespace clpv
