// SPDX-License-Identifier: MIT
// Transports of light between cells: their coefficients for a basis, in double, without OpenCL
// (docs/method.md, 'Propagation', 'The sweep'). A transport accesses any basis through the
// interface Basis.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <variant>
#include <vector>

#include "basis/basis.hpp"
#include "basis/rotated_lobe.hpp"
#include "support/named_enum.hpp"

namespace clpv {

// Representations of blockers in the geometry volume, and the blocking potential along a direction
// (docs/method.md, 'Blockers'). Without OpenCL.

/// Representation of a surfel of normal n whose area is the share A of a cell's cross-section.
enum class Blocking {
  /// 3 numbers: A |n_x|, A |n_y|, A |n_z|, the covered share of a face across each axis.
  areas,
  one_sided,  ///< N coefficients: A times the clamped cosine about n; blocks light against n only
              ///< (the paper)
};

template <>
inline constexpr auto kNames<Blocking> = name_list("areas", "one-sided");

/// Returns true if surfels are lobes in the light's basis.
bool blocks_by_lobes(Blocking blocking);

/// Returns the number of coefficients per sample of the geometry volume.
int blocking_size(Blocking blocking, const Basis& basis);

/// Returns the weights of these coefficients in the blocking potential B of light along the unit
/// vector `direction`. `one_sided`: b_i(-direction). `areas`: |direction_a|, exact for light along
/// an axis and for surfels across an axis.
std::vector<double> blocking_weights(Blocking blocking, const Basis& basis,
                                     const LobeOptions& lobes, const glm::dvec3& direction);

/// One of the 30 links from a source cell to a face of a neighbour (Kaplanyan and Dachsbacher 2010;
/// docs/method.md, 'Propagation').
struct Face {
  glm::ivec3 travel;  ///< k: from the source cell to its neighbour, a unit axis
  /// n_f: outward normal of the neighbour's face; equals travel for the far face.
  glm::ivec3 normal;
  glm::dvec3 direction;  ///< w_f, unit: from the source's centre to the face's centre
  double solid_angle;    ///< Omega_f, seen from the source's centre [sr]
  /// N: flux through the face [W] is flux . c, before blocking and clamping.
  std::vector<double> flux;
  std::vector<double> blocked_by;  ///< blocking_weights() of the link
};

/// Transport by fluxes through faces, clamped at 0 and re-emitted as lobes: `sampled` (the paper)
/// and `exact`.
struct FaceTransport {
  /// 30: six neighbours (+x -x +y -y +z -z), far face first, then four sides.
  std::vector<Face> faces;
  Matrix lobes;  ///< N x 6: coefficients per 1 W through the face of normal +x -x +y -y +z -z
};

/// One of a sweep's 26 links into a cell from a neighbour, through their common face, edge or
/// corner.
struct SweepLink {
  glm::ivec3 offset;               ///< from the neighbour to the cell [cells]
  glm::dvec3 direction;            ///< unit
  std::vector<double> blocked_by;  ///< as Face::blocked_by
};

enum class TransportKind {
  sampled,  ///< fluxes through faces, each sampled at its centre (the paper)
  exact,    ///< fluxes through faces, integrated over each face
  sweep,    ///< one pass per direction through the grid (basis/sweep.hpp)
};

/// Returns true if the scheme is a FaceTransport. Irradiance is then E(n) = 4 b(-n) . c / s^2; for
/// the sweep E(n) = alpha(-n) . c / s^2, alpha the clamped-cosine integrals (docs/method.md,
/// 'Gathering').
constexpr bool has_faces(TransportKind kind) {
  return kind == TransportKind::sampled || kind == TransportKind::exact;
}

template <>
inline constexpr auto kNames<TransportKind> = name_list("sampled", "exact", "sweep");

/// A transport for one basis.
struct Transport {
  TransportKind kind = TransportKind::sampled;
  LobeOptions lobes;
  Blocking blocking = Blocking::one_sided;
  std::variant<FaceTransport, std::vector<SweepLink>> scheme;
  /// True: injection scales each virtual point light's lobe f so that Int f dw equals its flux.
  bool unit_flux_lobes = false;
};

/// Returns the transports that move light in steps: all except the sweep.
std::vector<TransportKind> stepped_transports();

/// Builds a transport for `basis`. The sweep ignores `lobes`. `blocking`: representation of the
/// geometry volume.
Transport make_transport(TransportKind kind, const Basis& basis, const LobeOptions& lobes = {},
                         Blocking blocking = Blocking::one_sided);

/// The six axes in the order used everywhere: +x -x +y -y +z -z.
extern const std::array<glm::ivec3, 6> kAxes;

enum class FaceFlux {
  sampled,  ///< Omega_f b(w_f): sampled at the face's centre (the paper)
  exact,    ///< integral of b over the face's cone; lobes of unit flux
};

/// Builds the 30 faces and 6 lobes, without blocking weights.
FaceTransport make_face_transport(const Basis& basis, FaceFlux flux, const LobeOptions& lobes);

/// Solid angles [sr] of a neighbour's far face, and of each of its four side faces, from the
/// source's centre.
double far_solid_angle();
double side_solid_angle();

}  // namespace clpv
