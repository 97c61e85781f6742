// SPDX-License-Identifier: MIT
// Basis of functions on the sphere: f(w) = sum_i c_i b_i(w) (docs/bases.md). In double, without
// OpenCL.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "basis/matrix.hpp"
#include "support/literals.hpp"

namespace clpv {

/// N functions b_i on the unit sphere, with the integrals that stages need, and
/// their tables for kernels.
/// Immutable. Stages use any basis through this interface and never depend on its name.
class Basis {
 public:
  virtual ~Basis() = default;

  const std::string& name() const { return name_; }
  int size() const { return size_; }  ///< N
  double lambda() const;  ///< bandwidth shared by all centres; 0 if there is none or several differ
  /// SRBF bandwidths in (0, 1), one per centre; empty for other bases.
  const std::vector<double>& lambdas() const { return lambdas_; }
  std::string lambda_text() const;  ///< bandwidth for messages: "0.25", "0.1 to 0.4"
  /// Unit SRBF centres; empty for other bases.
  const std::vector<glm::dvec3>& centres() const { return centres_; }

  /// Computes b_i(w) of a unit w. b: N values.
  virtual void evaluate(const glm::dvec3& w, std::span<double> b) const = 0;
  /// Computes alpha_i(d) = Int b_i(w) max(0, w . d) dw of a unit d. alpha: N values (docs/bases.md,
  /// 'The clamped cosine').
  virtual void cosine_integrals(const glm::dvec3& d, std::span<double> alpha) const = 0;

  /// Adds CLPV_BASIS and the tables of the functions' header (kernels/basis/basis.h).
  virtual void add_literals(Literals& literals) const = 0;

  /// Number of bands of spherical harmonics, in the order of SphericalHarmonics; 0: another basis.
  virtual int bands() const { return 0; }

  /// Unit normals of planes through the origin where functions are discontinuous: quadrature splits
  /// there.
  virtual std::vector<glm::dvec3> creases() const { return {}; }

  const Matrix& gram() const { return gram_; }  ///< N x N: A_ij = Int b_i b_j dw
  const Matrix& gram_inverse() const { return gram_inverse_; }
  double condition() const { return condition_; }  ///< 2-norm condition number of A
  /// N: Int b_i dw; the energy of f is c . integrals.
  const std::vector<double>& integrals() const { return integrals_; }

  std::vector<double> evaluate(const glm::dvec3& w) const;
  double value(std::span<const double> c, const glm::dvec3& w) const;  ///< f(w)
  double energy(std::span<const double> c) const;                      ///< Int f dw
  /// Exact projection of the clamped cosine max(0, w . d): A^-1 alpha(d).
  std::vector<double> clamped_cosine(const glm::dvec3& d) const;
  /// Exact projection of the constant 1.
  std::vector<double> constant() const;

 protected:
  Basis() = default;
  /// Sets A, A^-1, the condition number and Int b_i dw.
  /// Throws Error(usage) if the condition number exceeds kMaxCondition.
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
inline constexpr double kMaxCondition = 1e7;  ///< beyond it float coefficients lose precision

/// Returns the basis `name` ("sh2", "srbf8v2", ...; see basis_names()). Only SRBF bases use
/// `lambda`. Throws Error(usage) for an unknown name (the message lists all names), lambda outside
/// (0, 1), or a Gram matrix with a condition number above kMaxCondition.
std::unique_ptr<Basis> make_basis(const std::string& name, double lambda = kDefaultLambda);
std::vector<std::string> basis_names();

inline constexpr std::size_t kMaxCentres = 64;  ///< kernels unroll loops over functions
/// Closer centres make the Gram matrix singular.
inline constexpr double kMinCentreDistance = 1e-3;

/// Returns an SRBF basis of 1 to kMaxCentres unit centres, at least kMinCentreDistance apart, with
/// one lambda or one per centre. Throws Error(usage) like make_basis(), and for invalid centres.
std::unique_ptr<Basis> make_basis_from_centres(const std::string& name,
                                               const std::vector<glm::dvec3>& centres,
                                               double lambda = kDefaultLambda);
std::unique_ptr<Basis> make_basis_from_centres(const std::string& name,
                                               const std::vector<glm::dvec3>& centres,
                                               const std::vector<double>& lambdas);

inline constexpr std::uintmax_t kCentresBytes = 1 << 20;  ///< maximum of a file of centres

/// Loads an SRBF basis from a JSON file {"name": "mine", "lambda": 0.3, "centres": [[x, y, z],
/// ...]}. Directions may have any length. The default name is the file's stem. "lambda", a number
/// or a list of one per centre, overrides the argument. Throws Error(bad_input) with the JSON
/// pointer of the invalid value, and Error(usage) like make_basis().
std::unique_ptr<Basis> load_basis(const std::string& path, double lambda = kDefaultLambda);

}  // namespace clpv
