// SPDX-License-Identifier: MIT
// How light moves from a cell to its neighbours: constants of a basis, computed in double. Knows no OpenCL.
// A transport is made for a basis through Basis's interface; neither knows the other's names.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <variant>
#include <vector>

#include "basis/basis.hpp"
#include "basis/blocking.hpp"
#include "basis/rotated_lobe.hpp"
#include "basis/transport.hpp"
#include "support/named_enum.hpp"

namespace clpv {

/// One of the thirty links from a source cell to a face of a neighbour (Kaplanyan & Dachsbacher 2010;
/// docs/method.md, 'Propagation').
struct Face {
  glm::ivec3 travel;         ///< k: from the source cell to its neighbour, a unit axis
  glm::ivec3 normal;         ///< n_f: outward normal of the neighbour's face; equals travel for the far face
  glm::dvec3 direction;      ///< w_f, unit: from the source's centre to the face's centre
  double solid_angle;        ///< Omega_f, seen from the source's centre [sr]
  std::vector<double> flux;  ///< N: flux through the face [W] = flux . c, before blocking and clamping
  std::vector<double> blocked_by;  ///< blocking_weights of what blocks on the link
};

/// Fluxes through faces, clamped at 0, re-emitted as lobes: `sampled` (the paper) and `exact`.
struct FaceTransport {
  std::vector<Face> faces;  ///< 30: six neighbours (+x -x +y -y +z -z), far face first, then four sides
  Matrix lobes;  ///< N x 6: what 1 W through the face of normal +x -x +y -y +z -z adds to the coefficients
};

/// One of a sweep's 26 links into a cell from a neighbour, through the face, edge or corner that the two share.
struct SweepLink {
  glm::ivec3 offset;               ///< how far the light travels, in cells
  glm::dvec3 direction;            ///< unit
  std::vector<double> blocked_by;  ///< as in Face
};

enum class TransportKind {
  sampled,  ///< the paper's: fluxes through faces, each seen along one direction
  exact,    ///< fluxes through faces, integrated over each
  sweep,    ///< no steps: directions of its own, swept through the grid (basis/sweep.hpp); here its links
};

/// Whether its scheme is a FaceTransport. Then gathering evaluates radiant intensity, E(n) = 4 b(-n) . c / s^2; of swept light
/// irradiance, E(n) = alpha(-n) . c / s^2, alpha the integrals over the clamped cosine (docs/method.md, 'Gathering').
constexpr bool has_faces(TransportKind kind) {
  return kind == TransportKind::sampled || kind == TransportKind::exact;
}

template <>
inline constexpr auto kNames<TransportKind> = name_list("sampled", "exact", "sweep");

struct Transport {
  TransportKind kind = TransportKind::sampled;
  LobeOptions lobes;  ///< that it was made with, and so is
  Blocking blocking = Blocking::one_sided;
  std::variant<FaceTransport, std::vector<SweepLink>> scheme;
  /// Lobes carry their nominal flux exactly: injection scales each virtual point light's lobe f to Int f dw =
  /// its flux.
  bool unit_flux_lobes = false;
};

/// Those that move light in steps: all but the sweep.
std::vector<TransportKind> stepped_transports();

/// A sweep has no lobes: `lobes` does not matter to it. `blocking`: what the geometry volume holds.
Transport make_transport(TransportKind kind, const Basis& basis, const LobeOptions& lobes = {},
                         Blocking blocking = Blocking::one_sided);

/// The six axes in the order used everywhere: +x -x +y -y +z -z.
extern const std::array<glm::ivec3, 6> kAxes;

enum class FaceFlux {
  sampled,  ///< Omega_f b(w_f): the paper's, the face's centre stands for all of it
  exact,    ///< integrals of b over the face's cone; lobes of unit flux
};

FaceTransport make_face_transport(const Basis& basis, FaceFlux flux, const LobeOptions& lobes);

/// Solid angles of the far face and of each of the four side faces of a neighbour, seen from the source's
/// centre [sr].
double far_solid_angle();
double side_solid_angle();

}  // namespace clpv
