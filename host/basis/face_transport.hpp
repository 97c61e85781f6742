// SPDX-License-Identifier: MIT
// The paper's way from cell to cell: fluxes through faces, re-emitted as lobes (docs/method.md, 'Propagation').
#pragma once

#include "basis/transport.hpp"

namespace clpv {

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
