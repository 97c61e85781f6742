// SPDX-License-Identifier: MIT
#include "codegen/transport_source.hpp"

#include <algorithm>

namespace clpv {
namespace {

/// 30 x N: half the flux through each face by each function's coefficient.
Matrix half_fluxes(const FaceTransport& scheme) {
  Matrix rows(static_cast<int>(scheme.faces.size()),
              static_cast<int>(scheme.faces.front().flux.size()));
  for (int f = 0; f < rows.rows(); ++f) {
    for (int i = 0; i < rows.columns(); ++i) rows(f, i) = 0.5 * scheme.faces[f].flux[i];
  }
  return rows;
}

/// 6 x N, for a normal along each of kAxes.
Matrix lobes_by_axis(const FaceTransport& scheme) {
  Matrix rows(scheme.lobes.columns(), scheme.lobes.rows());
  for (int axis = 0; axis < rows.rows(); ++axis) {
    for (int i = 0; i < rows.columns(); ++i) rows(axis, i) = scheme.lobes(i, axis);
  }
  return rows;
}

}  // namespace

std::string transport_source(const Basis& basis, const Transport& transport) {
  const auto& scheme = std::get<FaceTransport>(transport.scheme);
  std::vector<int> normals;
  for (const Face& face : scheme.faces)
    normals.push_back(static_cast<int>(std::ranges::find(kAxes, face.normal) - kAxes.begin()));
  return coefficient_text(basis.size()) + matrix_macro("CLPV_FACE_FLUX", half_fluxes(scheme)) +
         index_macro("CLPV_FACE_NORMAL", normals) +
         matrix_macro("CLPV_LOBES", lobes_by_axis(scheme));
}

OperationCount step_operations(const Transport& transport, bool blocking) {
  const auto& scheme = std::get<FaceTransport>(transport.scheme);
  const int faces = static_cast<int>(scheme.faces.size());
  OperationCount count;
  count.fused = products(half_fluxes(scheme)) + products(scheme.lobes);
  count.additions = faces;  // 2 max(0, h) = h + |h|
  (blocking ? count.fused : count.additions) += faces;
  return count;
}

}  // namespace clpv
