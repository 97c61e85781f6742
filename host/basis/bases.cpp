// SPDX-License-Identifier: MIT
#include "basis/bases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "basis/clamped_cosine.hpp"
#include "basis/transport.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

using std::numbers::pi;

// Coefficients of the Legendre polynomial P_l, [i] for z^i: (n+1) P_{n+1} = (2n+1) z P_n - n
// P_{n-1}.
std::vector<double> legendre(int l) {
  std::vector<double> before{0}, now{1};
  for (int n = 0; n < l; ++n) {
    std::vector<double> next(static_cast<std::size_t>(n) + 2, 0.0);
    for (std::size_t i = 0; i < now.size(); ++i) next[i + 1] += (2.0 * n + 1) / (n + 1) * now[i];
    for (std::size_t i = 0; i < before.size(); ++i)
      next[i] -= static_cast<double>(n) / (n + 1) * before[i];
    before = now;
    now = next;
  }
  return now;
}

std::vector<double> derivative(const std::vector<double>& p) {
  std::vector<double> d;
  for (std::size_t i = 1; i < p.size(); ++i) d.push_back(static_cast<double>(i) * p[i]);
  return d;
}

// K_lm, the normalisation of Y_lm.
double norm(int l, int m) {
  double ratio = 1;  // (l - m)! / (l + m)!
  for (int i = l - m + 1; i <= l + m; ++i) ratio /= i;
  return std::sqrt((2 * l + 1) / (4 * pi) * ratio * (m == 0 ? 1 : 2));
}

double value_of(const std::vector<double>& polynomial, double z) {
  double sum = 0;
  for (std::size_t i = polynomial.size(); i-- > 0;) sum = sum * z + polynomial[i];
  return sum;
}

}  // namespace

SphericalHarmonics::SphericalHarmonics(int bands) : bands_(bands) {
  name_ = fmt::format("sh{}", bands);
  size_ = bands * bands;
  for (int l = 0; l < bands; ++l) {
    for (int m = -l; m <= l; ++m) {
      std::vector<double> p = legendre(l);
      for (int i = 0; i < std::abs(m); ++i) p = derivative(p);
      for (double& c : p) c *= norm(l, std::abs(m));
      functions_.push_back({l, m, p});
    }
  }
  std::vector<double> integrals(size_, 0.0);
  integrals[0] = std::sqrt(4 * pi);
  set_gram(Matrix::identity(size_), integrals);
}

void SphericalHarmonics::evaluate(const glm::dvec3& w, std::span<double> b) const {
  std::vector<double> re{1}, im{0};  // (x + iy)^m
  for (int m = 1; m < bands_; ++m) {
    re.push_back(w.x * re.back() - w.y * im.back());
    im.push_back(w.x * im.back() + w.y * re[re.size() - 2]);
  }
  for (std::size_t i = 0; i < functions_.size(); ++i) {
    const Function& f = functions_[i];
    const std::size_t m = std::abs(f.order);
    b[i] = (f.order < 0 ? im[m] : re[m]) * value_of(f.polynomial, w.z);
  }
}

void SphericalHarmonics::cosine_integrals(const glm::dvec3& d, std::span<double> alpha) const {
  evaluate(d, alpha);
  for (std::size_t i = 0; i < functions_.size(); ++i) alpha[i] *= cosine_band(functions_[i].band);
}

void SphericalHarmonics::add_literals(Literals& literals) const {
  Matrix values(size_, (bands_ + 1) / 2), cosines = values;
  for (int i = 0; i < size_; ++i) {
    const Function& f = functions_[i];
    // Q_lm is even or odd in z: a polynomial in z^2, times z if odd.
    const std::size_t odd = (f.polynomial.size() - 1) % 2;
    for (std::size_t k = odd; k < f.polynomial.size(); k += 2) {
      values(i, static_cast<int>(k / 2)) = f.polynomial[k];
      cosines(i, static_cast<int>(k / 2)) = cosine_band(f.band) * f.polynomial[k];
    }
  }
  literals.word("CLPV_BASIS", "CLPV_HARMONICS")
      .integer("CLPV_BANDS", bands_)
      .matrix("CLPV_Y", values)
      .matrix("CLPV_COSINE_Y", cosines);
}

namespace {

// Boundary between the inner and outer bins of a face of bins96. Equal angles minimise the mean
// lobe error.
const double kLine = std::tan(std::numbers::pi / 8);
constexpr int kPatchesAlongFace = 4;

// Heaviside step: 1 for s > 0, 0 for s < 0, 1/2 on the boundary.
double step(double s) {
  return s > 0 ? 1 : (s < 0 ? 0 : 0.5);
}

std::vector<double> inner_lines(int side) {
  return side == 2 ? std::vector<double>{0} : std::vector<double>{-kLine, 0, kLine};
}

}  // namespace

DirectionBins::DirectionBins(int side) : side_(side), lines_(inner_lines(side)) {
  size_ = 6 * side * side;
  name_ = fmt::format("bins{}", size_);
  std::vector<double> corners = inner_lines(kPatchesAlongFace);
  corners.insert(corners.begin(), -1);
  corners.push_back(1);
  const int patches_per_bin = kPatchesAlongFace / side;
  std::vector<double> solid_angles(size_, 0.0);
  for (int face = 0; face < 6; ++face) {
    for (std::size_t v = 0; v < kPatchesAlongFace; ++v) {
      for (std::size_t u = 0; u < kPatchesAlongFace; ++u) {
        const SphericalPolygon polygon =
            face_region(face, {corners[u], corners[u + 1]}, {corners[v], corners[v + 1]});
        const int bin = (face * side + static_cast<int>(v) / patches_per_bin) * side +
                        static_cast<int>(u) / patches_per_bin;
        solid_angles[bin] += solid_angle(polygon);
        add_patch(bin, polygon);
      }
    }
  }
  Matrix gram(size_, size_);
  for (int i = 0; i < size_; ++i) gram(i, i) = solid_angles[i];
  set_gram(std::move(gram), std::move(solid_angles));
}

FaceAxes axes_of(int face) {
  const int n = face / 2;
  return {n, (n + 1) % 3, (n + 2) % 3, face % 2 == 0 ? 1.0 : -1.0};
}

SphericalPolygon face_region(int face, std::array<double, 2> u, std::array<double, 2> v) {
  const FaceAxes axes = axes_of(face);
  SphericalPolygon corners;
  for (const auto& [i, j] : {std::pair<std::size_t, std::size_t>{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
    glm::dvec3 corner;
    corner[axes.n] = axes.sign;
    corner[axes.u] = u[i];
    corner[axes.v] = v[j];
    corners.push_back(glm::normalize(corner));
  }
  return corners;
}

void DirectionBins::add_patch(int bin, const SphericalPolygon& polygon) {
  double total = 0;
  glm::dvec3 area(0);
  for (const QuadratureNode& node : nodes_of(polygon)) {
    total += node.weight;
    area += node.weight * node.w;
  }
  // Variance along one axis: half the mean square distance from the patch's middle. A uniform
  // distribution of that variance has a width of sqrt(12 variance).
  const glm::dvec3 middle = glm::normalize(area);
  double across = 0;
  for (const QuadratureNode& node : nodes_of(polygon)) {
    across += node.weight * (1 - glm::dot(node.w, middle) * glm::dot(node.w, middle));
  }
  patches_.push_back({bin, area, std::sqrt(12 * across / (2 * total)) * total});
}

std::vector<glm::dvec3> DirectionBins::creases() const {
  std::vector<glm::dvec3> planes;
  const double half = std::sqrt(0.5);
  for (const glm::dvec3& edge :
       {glm::dvec3(1, 1, 0), {1, -1, 0}, {0, 1, 1}, {0, 1, -1}, {1, 0, 1}, {-1, 0, 1}}) {
    planes.push_back(half * edge);
  }
  for (int n = 0; n < 3; ++n) {
    for (int t = 1; t < 3; ++t) {
      for (const double line : lines_) {
        glm::dvec3 plane(0);
        plane[(n + t) % 3] = 1;
        plane[n] = -line;
        planes.push_back(glm::normalize(plane));
      }
    }
  }
  return planes;
}

void DirectionBins::evaluate(const glm::dvec3& w, std::span<double> b) const {
  const std::size_t side = side_;
  const auto share = [&](double t, double n, std::size_t i) {
    const double above = i == 0 ? 1 : step(t - lines_[i - 1] * n);
    return above - (i + 1 == side ? 0 : step(t - lines_[i] * n));
  };
  std::array<double, 6> of_face{};
  double sum = 0;  // of six faces: 1, or 3/4 towards a corner of the cube
  for (int face = 0; face < 6; ++face) {
    const FaceAxes axes = axes_of(face);
    const double n = axes.sign * w[axes.n];
    sum += of_face[face] = step(n - std::abs(w[axes.u])) * step(n - std::abs(w[axes.v]));
  }
  for (int face = 0; face < 6; ++face) {
    const FaceAxes axes = axes_of(face);
    const double n = axes.sign * w[axes.n];
    for (std::size_t i = 0; i < side * side; ++i) {
      b[static_cast<std::size_t>(face) * side * side + i] =
          of_face[face] / sum * share(w[axes.u], n, i % side) * share(w[axes.v], n, i / side);
    }
  }
}

void DirectionBins::cosine_integrals(const glm::dvec3& d, std::span<double> alpha) const {
  std::ranges::fill(alpha, 0.0);
  double sum = 0;
  for (const Patch& patch : patches_) {
    const double t = glm::dot(patch.area, d);
    const double above = std::clamp(t / patch.width + 0.5, 0.0, 1.0);  // share above the horizon
    const double integral =
        0.5 * patch.width * above * above + std::max(0.0, t - 0.5 * patch.width);
    alpha[patch.bin] += integral;
    sum += integral;
  }
  for (double& value : alpha) value *= std::numbers::pi / sum;
}

void DirectionBins::add_literals(Literals& literals) const {
  std::vector<int> placed(size_, 0);  // patches of each bin so far
  const int patches = static_cast<int>(patches_.size()) / size_;
  Matrix x(patches, size_), y = x, z = x, width = x, per_width = x;
  for (const Patch& patch : patches_) {
    const int row = placed[patch.bin]++;
    x(row, patch.bin) = patch.area.x;
    y(row, patch.bin) = patch.area.y;
    z(row, patch.bin) = patch.area.z;
    width(row, patch.bin) = patch.width;
    per_width(row, patch.bin) = 1 / patch.width;
  }
  literals.word("CLPV_BASIS", "CLPV_BINS")
      .integer("CLPV_SIDE", side_)
      .reals("CLPV_LINES", lines_)
      .integer("CLPV_BIN_PATCHES", patches)
      .matrix("CLPV_PATCH_X", x)
      .matrix("CLPV_PATCH_Y", y)
      .matrix("CLPV_PATCH_Z", z)
      .matrix("CLPV_PATCH_WIDTH", width)
      .matrix("CLPV_PATCH_PER_WIDTH", per_width);
}

namespace {

using std::numbers::pi;

std::vector<glm::dvec3> axes() {
  return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
}

std::vector<glm::dvec3> cube() {
  std::vector<glm::dvec3> corners;
  for (const double z : {1.0, -1.0}) {
    for (const double y : {1.0, -1.0}) {
      for (const double x : {1.0, -1.0}) corners.push_back(glm::dvec3(x, y, z) / std::sqrt(3.0));
    }
  }
  return corners;
}

// Adds three directions with z-coordinate z, 120 degrees apart.
void add_ring(std::vector<glm::dvec3>& centres, double z, double first_degrees) {
  const double radius = std::sqrt(1 - z * z);
  for (int i = 0; i < 3; ++i) {
    const double azimuth = (first_degrees + 120 * i) * pi / 180;
    centres.emplace_back(radius * std::cos(azimuth), radius * std::sin(azimuth), z);
  }
}

// The rings are 60 degrees apart: a relative rotation changes the lobe error between 0.196 and
// 0.308.
std::vector<glm::dvec3> two_rings() {
  std::vector<glm::dvec3> centres{{0, 0, 1}, {0, 0, -1}};
  add_ring(centres, 1.0 / 3, 0);
  add_ring(centres, -1.0 / 3, 60);
  return centres;
}

std::vector<glm::dvec3> tetrahedron() {
  std::vector<glm::dvec3> centres{{0, 0, 1}};
  add_ring(centres, -1.0 / 3, 0);
  return centres;
}

std::vector<glm::dvec3> joined(std::vector<glm::dvec3> a, const std::vector<glm::dvec3>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// For each centre, the index of an earlier centre that is its antipode with equal lambda, else its
/// own index.
std::vector<int> opposites_of(const Basis& basis) {
  std::vector<int> opposites;
  for (std::size_t i = 0; i < basis.centres().size(); ++i) {
    opposites.push_back(static_cast<int>(i));
    for (std::size_t j = 0; j < i; ++j) {
      const glm::dvec3 sum = basis.centres()[i] + basis.centres()[j];
      if (glm::dot(sum, sum) < 1e-24 && basis.lambdas()[i] == basis.lambdas()[j])
        opposites[i] = static_cast<int>(j);
    }
  }
  return opposites;
}

// Coefficients in u = t^2 of a Chebyshev series in x = 2u - 1.
std::vector<double> powers_of(const std::vector<double>& chebyshev) {
  std::vector<double> before{1}, now{-1, 2}, sum(chebyshev.size(), 0.0);  // T_0, T_1 in u
  const auto add = [&](const std::vector<double>& p, double c) {
    for (std::size_t i = 0; i < p.size(); ++i) sum[i] += c * p[i];
  };
  add(before, chebyshev[0]);
  for (std::size_t k = 1; k < chebyshev.size(); ++k) {
    add(now, chebyshev[k]);
    std::vector<double> next(now.size() + 1, 0.0);
    for (std::size_t i = 0; i < now.size(); ++i) {
      next[i + 1] += 4 * now[i];
      next[i] -= 2 * now[i];
    }
    for (std::size_t i = 0; i < before.size(); ++i) next[i] -= before[i];
    before = now;
    now = next;
  }
  return sum;
}

/// Returns true if the powers' terms cancel, as they do for lambda above about 0.5.
bool cancels(const std::vector<double>& powers, const std::vector<double>& chebyshev) {
  constexpr double kCancellation = 4;  // two bits of a float's 24
  double size = 0;
  for (const double term : powers) size += std::abs(term);
  return size >= kCancellation * chebyshev[0];
}

void require_usable(const std::string& name, const std::vector<glm::dvec3>& centres,
                    const std::vector<double>& lambdas) {
  if (centres.empty() || centres.size() > kMaxCentres) {
    throw Error(ExitCode::usage, "{}: found {} centres, allowed: 1 to {}", name, centres.size(),
                kMaxCentres);
  }
  for (const double lambda : lambdas) {
    if (!(lambda > 0 && lambda < 1)) {
      throw Error(ExitCode::usage, "{}: lambda: found {}, allowed: greater than 0 and less than 1",
                  name, lambda);
    }
  }
  for (std::size_t i = 0; i < centres.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double distance = glm::length(centres[i] - centres[j]);
      if (!(distance >= kMinCentreDistance)) {
        throw Error(ExitCode::usage,
                    "{}: centres {} and {}: found a distance of {:.2g}, allowed: at least {}", name,
                    j, i, distance, kMinCentreDistance);
      }
    }
  }
}

}  // namespace

double abel_poisson(double t, double lambda) {
  const double d = 1 - 2 * lambda * t + lambda * lambda;
  return (1 - lambda * lambda) / (d * std::sqrt(d));
}

const std::vector<SrbfSet>& srbf_sets() {
  static const std::vector<SrbfSet> sets{
      {"srbf4", tetrahedron()},
      {"srbf6", axes()},
      {"srbf8v1", two_rings()},
      {"srbf8v2", cube()},
      {"srbf8v3",
       joined(axes(), {glm::dvec3(1) / std::sqrt(3.0), glm::dvec3(-1) / std::sqrt(3.0)})},
      {"srbf14", joined(cube(), axes())},
  };
  return sets;
}

Srbf::Srbf(const std::string& name, const std::vector<glm::dvec3>& centres,
           const std::vector<double>& lambdas) {
  require_usable(name, centres, lambdas);
  name_ = name;
  lambdas_ = lambdas;
  centres_ = centres;
  size_ = centres.size();
  for (const double lambda : lambdas) cosines_.try_emplace(lambda, lambda);
  Matrix gram(size_, size_);
  for (int i = 0; i < size_; ++i) {
    for (int j = 0; j < size_; ++j) {
      const std::size_t a = i, b = j;
      const double t = i == j ? 1 : glm::dot(centres_[a], centres_[b]);
      gram(i, j) = 4 * pi * abel_poisson(t, lambdas_[a] * lambdas_[b]);
    }
  }
  set_gram(std::move(gram), std::vector<double>(centres.size(), 4 * pi));
}

void Srbf::evaluate(const glm::dvec3& w, std::span<double> b) const {
  for (std::size_t i = 0; i < centres_.size(); ++i)
    b[i] = abel_poisson(glm::dot(w, centres_[i]), lambdas_[i]);
}

void Srbf::cosine_integrals(const glm::dvec3& d, std::span<double> alpha) const {
  for (std::size_t i = 0; i < centres_.size(); ++i)
    alpha[i] = cosines_.at(lambdas_[i])(glm::dot(d, centres_[i]));
}

void Srbf::add_literals(Literals& literals) const {
  std::map<double, std::vector<double>> chebyshev, powers;
  std::size_t terms = 1;
  bool by_chebyshev = false;
  for (const auto& [lambda, cosine] : cosines_) {
    chebyshev[lambda] = cosine.chebyshev();
    powers[lambda] = powers_of(chebyshev[lambda]);
    terms = std::max(terms, chebyshev[lambda].size());
    by_chebyshev = by_chebyshev || cancels(powers[lambda], chebyshev[lambda]);
  }
  Matrix centres(size_, 3), poisson(size_, 3), even(size_, static_cast<int>(terms));
  std::vector<double> slope;
  for (int i = 0; i < size_; ++i) {
    const double lambda = lambdas_[i];
    for (int axis = 0; axis < 3; ++axis) centres(i, axis) = centres_[i][axis];
    const double numbers[] = {1 - lambda * lambda, 1 + lambda * lambda, 2 * lambda};
    std::ranges::copy(numbers, poisson.row(i).begin());
    std::ranges::copy((by_chebyshev ? chebyshev : powers)[lambda], even.row(i).begin());
    slope.push_back(cosines_.at(lambda).slope());
  }
  literals.word("CLPV_BASIS", "CLPV_RADIAL")
      .matrix("CLPV_CENTRES", centres)
      .integers("CLPV_OPPOSITES", opposites_of(*this))
      .matrix("CLPV_POISSON", poisson)
      .reals("CLPV_COSINE_SLOPE", slope)
      .integer("CLPV_COSINE_TERMS", terms)
      .flag("CLPV_COSINE_CHEBYSHEV", by_chebyshev)
      .matrix("CLPV_COSINE_EVEN", even);
}

}  // namespace clpv
