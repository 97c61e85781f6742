// SPDX-License-Identifier: MIT
// A basis of functions on the sphere: f(w) = sum_i c_i b_i(w). All in double; knows no OpenCL.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "basis/matrix.hpp"

namespace clpv {

/// N functions on the unit sphere, and what the stages need to know of them. Immutable.
/// Stages treat all bases alike through this interface; none asks for a name.
class Basis {
 public:
  virtual ~Basis() = default;

  const std::string& name() const { return name_; }
  int size() const { return size_; }  ///< N
  double lambda() const;              ///< the bandwidth all centres share; 0: the basis has none, or several
  /// SRBF bandwidths in (0, 1), one a centre; empty: the basis has none.
  const std::vector<double>& lambdas() const { return lambdas_; }
  std::string lambda_text() const;  ///< "0.25", "0.1 to 0.4"
  const std::vector<glm::dvec3>& centres() const {
    return centres_;
  }  ///< SRBF centres; empty: the basis has none

  /// b_i(w), i < N, for a unit w.
  virtual void evaluate(const glm::dvec3& w, std::span<double> b) const = 0;
  /// alpha_i(d) = Int b_i(w) max(0, w . d) dw, for a unit d (docs/bases.md, 'clamped cosine').
  virtual void cosine_integrals(const glm::dvec3& d, std::span<double> alpha) const = 0;

  /// OpenCL C that defines, for the struct `Coefficients` of N floats c0 .. c{N-1}:
  ///   static Coefficients clpv_basis(float x, float y, float z)             b_i(w), w unit
  ///   static Coefficients clpv_cosine_integrals(float x, float y, float z)  alpha_i(d), d unit
  virtual std::string kernel_source() const = 0;

  /// Unit normals of the planes through the origin across which the functions jump: quadrature splits there.
  virtual std::vector<glm::dvec3> creases() const { return {}; }

  const Matrix& gram() const { return gram_; }  ///< A_ij = Int b_i b_j dw
  const Matrix& gram_inverse() const { return gram_inverse_; }
  double condition() const { return condition_; }  ///< 2-norm condition number of A
  const std::vector<double>& integrals() const {
    return integrals_;
  }  ///< Int b_i dw: energy of f is c . integrals

  std::vector<double> evaluate(const glm::dvec3& w) const;
  double value(std::span<const double> c, const glm::dvec3& w) const;  ///< f(w)
  double energy(std::span<const double> c) const;                      ///< Int f dw
  /// Exact projection of the clamped cosine max(0, w . d): A^-1 alpha(d).
  std::vector<double> clamped_cosine(const glm::dvec3& d) const;
  /// Exact projection of the constant 1.
  std::vector<double> constant() const;

 protected:
  Basis() = default;
  /// Sets the Gram matrix, what follows from it, and Int b_i dw.
  /// Throws Error(usage) for a condition number above kLargestCondition.
  void set_gram(Matrix gram, std::vector<double> integrals);

  std::string name_;
  int size_ = 0;
  std::vector<double> lambdas_;
  std::vector<glm::dvec3> centres_;
  Matrix gram_, gram_inverse_;
  double condition_ = 1;
  std::vector<double> integrals_;
};

inline constexpr double kDefaultLambda = 0.25;
inline constexpr double kLargestCondition = 1e7;  ///< float coefficients lose their last digits beyond

/// The basis of that name ("sh2", "srbf8v2", ...; basis_names()). `lambda` matters to SRBF alone.
/// Throws Error(usage) for an unknown name (listing those there are), lambda outside (0, 1), or a Gram matrix
/// with a condition number above 1e7 (naming lambda and the number).
std::unique_ptr<Basis> make_basis(const std::string& name, double lambda = kDefaultLambda);
std::vector<std::string> basis_names();

inline constexpr std::size_t kMostCentres = 64;       ///< kernels are written out, function by function
inline constexpr double kLeastCentreDistance = 1e-3;  ///< nearer ones make the Gram matrix singular anyway

/// An SRBF set of a user's own: 1 to kMostCentres unit centres, no two nearer than kLeastCentreDistance, with one lambda,
/// or with one for each centre. Throws like make_basis, and for what is wrong with the centres.
std::unique_ptr<Basis> make_basis_from_centres(const std::string& name,
                                               const std::vector<glm::dvec3>& centres,
                                               double lambda = kDefaultLambda);
std::unique_ptr<Basis> make_basis_from_centres(const std::string& name,
                                               const std::vector<glm::dvec3>& centres,
                                               const std::vector<double>& lambdas);

/// The same from a JSON file {"name": "mine", "lambda": 0.3, "centres": [[x, y, z], ...]}, directions of any length.
/// Without a name it is called by the file's stem; `lambda`, which may be a list with one for each centre, replaces the
/// argument. Throws Error(bad_input) with the JSON pointer of what is wrong, and Error(usage) like make_basis.
std::unique_ptr<Basis> load_basis(const std::string& path, double lambda = kDefaultLambda);

}  // namespace clpv
