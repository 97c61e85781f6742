#include "basis/srbf.hpp"

#include <cmath>
#include <numbers>

#include "basis/srbf_kernel.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr double kPi = std::numbers::pi;

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

// Three directions of height z, 120 degrees apart.
void add_ring(std::vector<glm::dvec3>& centres, double z, double first_degrees) {
  const double radius = std::sqrt(1 - z * z);
  for (int i = 0; i < 3; ++i) {
    const double azimuth = (first_degrees + 120 * i) * kPi / 180;
    centres.emplace_back(radius * std::cos(azimuth), radius * std::sin(azimuth), z);
  }
}

// The azimuths matter: turning one ring against the other by 60 degrees makes the lobe error .196 to .308.
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
      {"srbf8v3", joined(axes(), {glm::dvec3(1) / std::sqrt(3.0), glm::dvec3(-1) / std::sqrt(3.0)})},
      {"srbf14", joined(cube(), axes())},
  };
  return sets;
}

Srbf::Srbf(const std::string& name, const std::vector<glm::dvec3>& centres, double lambda)
    : cosine_(lambda > 0 && lambda < 1
                  ? lambda
                  : throw Error(ExitCode::usage, "lambda is {}; {} needs one between 0 and 1, both excluded",
                                lambda, name)) {
  name_ = name;
  lambda_ = lambda;
  centres_ = centres;
  size_ = static_cast<int>(centres.size());
  Matrix gram(size_, size_);
  for (int i = 0; i < size_; ++i) {
    for (int j = 0; j < size_; ++j) {
      const double t =
          i == j ? 1 : glm::dot(centres_[static_cast<std::size_t>(i)], centres_[static_cast<std::size_t>(j)]);
      gram(i, j) = 4 * kPi * abel_poisson(t, lambda * lambda);
    }
  }
  set_gram(std::move(gram), std::vector<double>(centres.size(), 4 * kPi));
}

void Srbf::evaluate(const glm::dvec3& w, std::span<double> b) const {
  for (std::size_t i = 0; i < centres_.size(); ++i) b[i] = abel_poisson(glm::dot(w, centres_[i]), lambda_);
}

void Srbf::cosine_integrals(const glm::dvec3& d, std::span<double> alpha) const {
  for (std::size_t i = 0; i < centres_.size(); ++i) alpha[i] = cosine_(glm::dot(d, centres_[i]));
}

std::string Srbf::kernel_source() const {
  return srbf_kernel_source(*this, cosine_);
}

}  // namespace clpv
