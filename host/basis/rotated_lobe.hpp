// SPDX-License-Identifier: MIT
// The paper's cosine lobes (its Appendix 2; docs/method.md, 'The paper's lobes and look-up
// tables'). The lobe about +z is projected once and rotated to each axis: c~ = A^-1 R c, R_ij =
// H_ij(xi_i . Rot xi_j), H_ij(t) = 4 pi G(t; lambda_i lambda_j) from a table. For comparison only:
// the exact projection (Basis::clamped_cosine) costs less and is never less accurate.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "support/named_enum.hpp"

namespace clpv {

enum class LobeKind {
  exact,   ///< exact projection for each axis
  rotate,  ///< projection about +z, rotated to the axis
};

template <>
inline constexpr auto kNames<LobeKind> = name_list("exact", "rotate");

/// Evaluation of lobes and basis functions. Has an effect only on bases with centres.
struct LobeOptions {
  LobeKind kind = LobeKind::exact;
  int table_size = 256;          ///< entries of the tables of H and G; 0: computes H
  bool table_functions = false;  ///< true: stages read basis functions from G's table
};

/// Returns a . b in float: each component, product and sum rounded, in order of x, y, z. As kernels
/// compute it.
float dot_in_float(const glm::dvec3& a, const glm::dvec3& b);

/// Table of a function of t in [-1, 1]. The first entry is for t = -1, the last for t = 1. Reads
/// without interpolation, as the paper's Appendix 2: entry int((t + 1) * 0.5 * (size - 1)) in
/// float. Where t falls on an entry, as 1/3 of the cube's corners does, rounding decides which
/// entry is read.
class ZonalTable {
 public:
  /// Throws Error(usage) for fewer than 2 or more than 2^20 entries.
  ZonalTable(int size, const std::function<double(double)>& function);

  double operator()(float t) const;
  double to_step(double t) const;  ///< distance from t to the next change of entry [entries]
  int size() const { return static_cast<int>(values_.size()); }
  /// Entries for a device.
  std::vector<float> values() const { return {values_.begin(), values_.end()}; }

 private:
  std::vector<double> values_;
};

/// Distinct parameters of a family of functions of t, and the index of the one that each member
/// uses.
struct Parameters {
  std::vector<double> values;      ///< distinct
  std::vector<std::size_t> index;  ///< into `values`, one per centre or pair of centres
};
Parameters gram_parameters(const Basis& basis);  ///< lambda_i lambda_j of H; pair (i, j) at i N + j
Parameters function_parameters(const Basis& basis);  ///< lambda_i of G

/// One table per distinct parameter.
struct ZonalTables {
  std::vector<ZonalTable> tables;
  std::vector<std::size_t> index;  ///< as Parameters::index

  /// Value at t of member `i`, a centre or pair of centres.
  double operator()(std::size_t i, float t) const { return tables[index[i]](t); }
  std::vector<float> values() const;  ///< entries of all tables in order, for a device
};

/// Returns tables of H (gram_tables) or of the basis functions G (function_tables), `size` entries
/// each. Throws Error(usage) for more than 2^24 entries in total.
ZonalTables gram_tables(const Basis& basis, int size);
ZonalTables function_tables(const Basis& basis, int size);

/// Returns b_i(w) by function_tables() (Evaluation::table). Bases without centres have no table and
/// use Basis::evaluate().
std::vector<double> evaluate(const Basis& basis, const ZonalTables& tables, const glm::dvec3& w);
/// Returns b_i(w), from a table or computed as `options` require.
std::vector<double> evaluate(const Basis& basis, const LobeOptions& options, const glm::dvec3& w);

/// Returns the smallest rotation of +z to the unit vector `axis`. For -z, where it is not unique: a
/// half turn about x.
glm::dmat3 rotation_to(const glm::dvec3& axis);

/// Clamped-cosine lobes of one basis. Bases without centres always use the exact projection:
/// spherical harmonics rotate exactly, and direction bins cannot be rotated.
class Lobes {
 public:
  Lobes(const Basis& basis, const LobeOptions& options);

  /// Returns the N coefficients of the lobe about the unit vector `axis`.
  std::vector<double> operator()(const glm::dvec3& axis) const;

 private:
  /// Returns H_ij(a . b).
  double gram(std::size_t i, std::size_t j, const glm::dvec3& a, const glm::dvec3& b) const;

  const Basis& basis_;
  bool rotate_;
  std::optional<ZonalTables> tables_;  ///< tables of H; none: computes H
  std::vector<double> up_lobe_;        ///< the lobe about +z
};

}  // namespace clpv
