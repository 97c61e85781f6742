// The paper's cosine lobes (Appendix 2): the lobe towards +z is projected once and turned to each axis by
// c~ = A^-1 R c, R_ij = H(xi_i . Rot xi_j), H(t) = 4 pi G(t; lambda^2) read from a table. An option, for
// comparison: the exact projection (Basis::clamped_cosine) costs less and is nowhere worse.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <string_view>
#include <vector>

#include "basis/basis.hpp"

namespace clpv {

enum class LobeKind {
  exact,   ///< projected for each axis
  rotate,  ///< projected towards +z, turned to the axis
};

constexpr std::string_view name_of(LobeKind kind) {
  switch (kind) {
    case LobeKind::exact:
      return "exact";
    case LobeKind::rotate:
      return "rotate";
  }
  return {};
}

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

/// H of an SRBF set, and G, the basis function itself.
ZonalTable gram_table(const Basis& basis, int size);
ZonalTable function_table(const Basis& basis, int size);

/// b_i(w) with G from `function_table` (Evaluation::table). A basis without centres has no table: its own evaluate().
std::vector<double> evaluate(const Basis& basis, const ZonalTable& table, const glm::dvec3& w);
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
  const Basis& basis_;
  bool rotate_;
  std::function<double(double)> gram_;  ///< H, from the table where there is one
  std::vector<double> upwards_;         ///< the lobe towards +z
};

}  // namespace clpv
