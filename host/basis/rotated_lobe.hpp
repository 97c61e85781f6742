// SPDX-License-Identifier: MIT
// The paper's cosine lobes (Appendix 2): the lobe towards +z is projected once and turned to each axis by
// c~ = A^-1 R c, R_ij = H_ij(xi_i . Rot xi_j), H_ij(t) = 4 pi G(t; lambda_i lambda_j) read from a table. An option, for
// comparison: the exact projection (Basis::clamped_cosine) costs less and is nowhere worse.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "support/named_enum.hpp"

namespace clpv {

enum class LobeKind {
  exact,   ///< projected for each axis
  rotate,  ///< projected towards +z, turned to the axis
};

template <>
inline constexpr auto kNames<LobeKind> = name_list("exact", "rotate");

/// How lobes and basis functions are come by. Matters to bases with centres alone.
struct LobeOptions {
  LobeKind kind = LobeKind::exact;
  int table_size = 256;          ///< entries of the tables of H and G; 0: H itself
  bool table_functions = false;  ///< basis functions are read from G's table where stages evaluate them
};

/// A function of t in [-1, 1] as a table of `size` entries, the first for t = -1 and the last for t = 1, read without
/// interpolation: entry floor((t + 1)/2 (size - 1) + 1/1024). The 1/1024 keeps a t that lies on an entry but for rounding
/// (the cube's 1/3) on it, in float as in double.
class ZonalTable {
 public:
  static constexpr double kIndexBias = 1.0 / 1024;

  /// Throws Error(usage) for less than 2 or more than 2^20 entries.
  ZonalTable(int size, const std::function<double(double)>& function);

  double operator()(double t) const;
  double to_step(double t) const;  ///< how far t is from where another entry is read, in entries
  int size() const { return static_cast<int>(values_.size()); }
  std::vector<float> values() const { return {values_.begin(), values_.end()}; }  ///< for a device

 private:
  double place(double t) const;

  std::vector<double> values_;
};

/// Parameters of a function of t, each once, and which of them a centre (or a pair of centres) takes.
struct Parameters {
  std::vector<double> values;
  std::vector<std::size_t> of;
};
/// H's lambda_i lambda_j, pair (i, j) at i N + j; and G's lambda_i.
Parameters gram_parameters(const Basis& basis);
Parameters function_parameters(const Basis& basis);

/// A table for each value of a parameter; of centres that share one lambda it is one table.
struct ZonalTables {
  std::vector<ZonalTable> each;
  std::vector<std::size_t> of;  ///< as Parameters::of

  double operator()(std::size_t which, double t) const { return each[of[which]](t); }
  std::vector<float> values() const;  ///< one table after the other, for a device
};

/// H of an SRBF set, and G, the basis function itself. Throw Error(usage) for more than 2^24 entries in all.
ZonalTables gram_tables(const Basis& basis, int size);
ZonalTables function_tables(const Basis& basis, int size);

/// b_i(w) with G from function_tables() (Evaluation::table). A basis without centres has no table: its own evaluate().
std::vector<double> evaluate(const Basis& basis, const ZonalTables& tables, const glm::dvec3& w);
/// b_i(w) as `options` want them.
std::vector<double> evaluate(const Basis& basis, const LobeOptions& options, const glm::dvec3& w);

/// The rotation that takes +z to `axis` (unit) and moves least; towards -z, where that is undefined, a half turn about x.
glm::dmat3 rotation_to(const glm::dvec3& axis);

/// Clamped-cosine lobes of one basis, by either way. Spherical harmonics rotate exactly, and direction bins cannot be
/// rotated: for a basis without centres both ways give the exact projection.
class Lobes {
 public:
  Lobes(const Basis& basis, const LobeOptions& options);

  /// The N coefficients of the lobe round `axis` (unit).
  std::vector<double> operator()(const glm::dvec3& axis) const;

 private:
  double gram(std::size_t i, std::size_t j, double t) const;

  const Basis& basis_;
  bool rotate_;
  std::optional<ZonalTables> tables_;  ///< of H; none: H itself
  std::vector<double> upwards_;        ///< the lobe towards +z
};

}  // namespace clpv
