// SPDX-License-Identifier: MIT
// Sources:
//   ambient cube      McTaggart, 'Half-Life 2 / Valve Source Shading' (GDC 2004); Mitchell et al.,
//                     'Shading in Valve's Source Engine' (SIGGRAPH 2006)
//   sh3               Ramamoorthi and Hanrahan, 'An Efficient Representation for Irradiance
//                     Environment Maps' (SIGGRAPH 2001)
//   sh2-geomerics     Hazel, 'Reconstructing Diffuse Lighting from Spherical Harmonic Data' (2017)
//   sh3-windowed      Sloan, 'Stupid Spherical Harmonics (SH) Tricks' (GDC 2008)
//   zh3               Roughton, Sloan, Silvennoinen, Iwanicki and Shirley, 'ZH3: Quadratic Zonal
//                     Harmonics' (I3D 2024)
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "bake/bake.hpp"
#include "basis/bases.hpp"
#include "basis/basis.hpp"
#include "basis/clamped_cosine.hpp"
#include "basis/quadrature.hpp"
#include "support/error.hpp"

namespace clpv::bake {
namespace {

using std::numbers::pi;
using Vectors = std::span<const glm::dvec3>;
using Weights = std::vector<double>;
using Functions = std::function<Weights(const glm::dvec3& n)>;

constexpr double kZonal = 0.6307831305050401;  // sqrt(5 / (4 pi)): Y_20 along its axis
const glm::dvec3 kLuminance(0.2126, 0.7152, 0.0722);

glm::dvec3 weighted(Vectors c, std::span<const double> weights) {
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * c[i];
  return sum;
}

/// Coefficients of a basis, projected exactly; irradiance by its cosine integrals.
ProbeFormat of_basis(const std::string& name, const std::string& basis_name) {
  const std::shared_ptr<const Basis> basis = make_basis(basis_name);
  ProbeFormat format;
  format.name = name;
  format.size = static_cast<std::size_t>(basis->size());
  format.meaning = "radiance that arrives [W/m^2/sr] in basis " + basis_name;
  format.moments = {format.size, [basis](const glm::dvec3& w, std::span<double> g) {
                      std::ranges::copy(basis->gram_inverse() * basis->evaluate(w), g.begin());
                    }};
  format.irradiance = [basis](Vectors c, const glm::dvec3& n) {
    Weights alpha(static_cast<std::size_t>(basis->size()));
    basis->cosine_integrals(n, alpha);
    return weighted(c, alpha);
  };
  format.creases = basis->creases();
  return format;
}

/// Values of irradiance / pi that functions of the normal interpolate. Least squares over
/// probe_normals().
ProbeFormat fitted(const std::string& name, int size, const Functions& functions) {
  const auto& [normals, solid_angles] = probe_normals();
  Matrix gram(size, size), fit(size, static_cast<int>(normals.size()));
  for (std::size_t k = 0; k < normals.size(); ++k) {
    const Weights b = functions(normals[k]);
    for (int i = 0; i < size; ++i) {
      fit(i, static_cast<int>(k)) = solid_angles[k] * b[i] / pi;
      for (int j = 0; j < size; ++j) gram(i, j) += solid_angles[k] * b[i] * b[j];
    }
  }
  fit = inverse(gram) * fit;
  ProbeFormat format;
  format.name = name;
  format.size = static_cast<std::size_t>(size);
  format.meaning = "irradiance / pi [W/m^2/sr] of the functions of the normal";
  format.moments = {format.size, [fit](const glm::dvec3& w, std::span<double> g) {
                      const std::vector<glm::dvec3>& all = probe_normals().normals;
                      Weights cosines(all.size());
                      for (std::size_t k = 0; k < all.size(); ++k)
                        cosines[k] = std::max(0.0, glm::dot(w, all[k]));
                      for (std::size_t i = 0; i < g.size(); ++i)
                        g[i] = dot(fit.row(static_cast<int>(i)), cosines);
                    }};
  format.irradiance = [functions](Vectors c, const glm::dvec3& n) {
    return pi * weighted(c, functions(n));
  };
  return format;
}

// Faces +x, -x, +y, -y, +z, -z.
Weights cube_weights(const glm::dvec3& n) {
  Weights weights(6, 0.0);
  for (int axis = 0; axis < 3; ++axis)
    weights[2 * static_cast<std::size_t>(axis) + (n[axis] < 0)] = n[axis] * n[axis];
  return weights;
}

/// Each face has the irradiance across it.
ProbeFormat cube_of_means() {
  ProbeFormat format = fitted("ambient-cube-mean", 6, cube_weights);
  format.moments.weights = [](const glm::dvec3& w, std::span<double> g) {
    for (int face = 0; face < 6; ++face)
      g[static_cast<std::size_t>(face)] =
          std::max(0.0, (face % 2 == 0 ? 1 : -1) * w[face / 2]) / pi;
  };
  return format;
}

/// Mean radiance, and the vector (1 / 4 pi) Int L w dw, of two bands.
struct Bands {
  glm::dvec3 mean;
  std::array<glm::dvec3, 3> flow;  // x, y, z; red, green, blue

  explicit Bands(Vectors c) : mean(c[0] * std::sqrt(1 / (4 * pi))) {
    const double to_flow = std::sqrt(1 / (12 * pi));
    flow = {c[3] * to_flow, c[1] * to_flow, c[2] * to_flow};
  }
};

/// pi R (a + (1 - a) (p + 1) q^p), q = (1 + cos) / 2, p = 1 + 2 r, a = (1 - r) / (1 + r), r = |R_1|
/// / R.
glm::dvec3 geomerics(Vectors c, const glm::dvec3& n) {
  const Bands bands(c);
  glm::dvec3 e(0);
  for (int channel = 0; channel < 3; ++channel) {
    const double mean = bands.mean[channel];
    const auto& [x, y, z] = bands.flow;
    const glm::dvec3 flow(x[channel], y[channel], z[channel]);
    const double length = glm::length(flow);
    if (!(mean > 0)) continue;
    const double r = std::min(length / mean, 1.0), p = 1 + 2 * r, a = (1 - r) / (1 + r);
    const double q = length > 0 ? std::clamp((1 + glm::dot(flow, n) / length) / 2, 0.0, 1.0) : 0.5;
    e[channel] = pi * mean * (a + (1 - a) * (p + 1) * std::pow(q, p));
  }
  return e;
}

/// Unit axis of the luminance of the second band; 0 if it is 0.
glm::dvec3 zonal_axis(Vectors c) {
  const glm::dvec3 axis(glm::dot(c[3], kLuminance), glm::dot(c[1], kLuminance),
                        glm::dot(c[2], kLuminance));
  const double length = glm::length(axis);
  return length > 0 ? axis / length : glm::dvec3(0);
}

const Basis& harmonics() {
  static const SphericalHarmonics kNine(3);
  return kNine;
}

/// Irradiance of four harmonics, and of the coefficient `zonal` of Y_20 about their axis.
glm::dvec3 with_zonal(Vectors four, const glm::dvec3& zonal, const glm::dvec3& n) {
  Weights alpha(9);
  harmonics().cosine_integrals(n, alpha);
  const double t = glm::dot(zonal_axis(four), n);
  return weighted(four, std::span(alpha).first(4)) +
         cosine_band(2) * kZonal * (3 * t * t - 1) / 2 * zonal;
}

/// The third band's part that is symmetric about the axis of the second: least squares.
std::vector<glm::dvec3> solve_zonal(Vectors nine) {
  std::vector<glm::dvec3> five(nine.begin(), nine.begin() + 4);
  const glm::dvec3 axis = zonal_axis(nine);
  const Weights y = harmonics().evaluate(axis);
  glm::dvec3 zonal(0);
  for (std::size_t i = 4; i < 9; ++i) zonal += nine[i] * (y[i] / kZonal);
  five.push_back(axis == glm::dvec3(0) ? glm::dvec3(0) : zonal);
  return five;
}

/// Nine coefficients times 1 / (1 + lambda l^2 (l + 1)^2).
std::vector<glm::dvec3> windowed(Vectors nine, double lambda) {
  std::vector<glm::dvec3> c(nine.begin(), nine.end());
  for (std::size_t i = 1; i < 9; ++i) c[i] /= 1 + lambda * (i < 4 ? 4 : 36);
  return c;
}

/// The smallest window with which no irradiance is negative.
std::vector<glm::dvec3> least_window(Vectors nine) {
  const auto negative = [&](double lambda) {
    const std::vector<glm::dvec3> c = windowed(nine, lambda);
    return std::ranges::any_of(probe_normals().normals, [&](const glm::dvec3& n) {
      Weights alpha(9);
      harmonics().cosine_integrals(n, alpha);
      const glm::dvec3 e = weighted(c, alpha);
      return std::min({e.x, e.y, e.z}) < 0;
    });
  };
  constexpr double kMost = 16;
  if (!negative(0) || negative(kMost)) return windowed(nine, 0);  // or no light at all
  double low = 0, high = kMost;
  for (int step = 0; step < 24; ++step) {
    const double middle = (low + high) / 2;
    (negative(middle) ? low : high) = middle;
  }
  return windowed(nine, high);
}

ProbeFormat geomerics_format() {
  ProbeFormat format = of_basis("sh2-geomerics", "sh2");
  format.irradiance = geomerics;
  return format;
}

ProbeFormat windowed_format() {
  ProbeFormat format = of_basis("sh3-windowed", "sh3");
  format.encode = least_window;
  return format;
}

ProbeFormat zh3_format() {
  ProbeFormat format = of_basis("zh3", "sh3");
  format.size = 5;
  format.meaning =
      "radiance that arrives [W/m^2/sr] in basis sh2; Y_20 about the second band's axis";
  format.encode = solve_zonal;
  format.irradiance = [](Vectors c, const glm::dvec3& n) {
    return with_zonal(c.first(4), c[4], n);
  };
  return format;
}

struct Entry {
  const char* name;
  ProbeFormat (*make)();
};

constexpr Entry kFormats[] = {
    {"sh2", [] { return of_basis("sh2", "sh2"); }},
    {"sh2-geomerics", geomerics_format},
    {"zh3", zh3_format},
    {"ambient-cube", [] { return fitted("ambient-cube", 6, cube_weights); }},
    {"ambient-cube-mean", cube_of_means},
    {"srbf6", [] { return of_basis("srbf6", "srbf6"); }},
    {"srbf8v2", [] { return of_basis("srbf8v2", "srbf8v2"); }},
    {"sh3", [] { return of_basis("sh3", "sh3"); }},
    {"sh3-windowed", windowed_format},
    {"srbf14", [] { return of_basis("srbf14", "srbf14"); }},
    {"bins24", [] { return of_basis("bins24", "bins24"); }},
};

}  // namespace

std::vector<std::string> probe_format_names() {
  std::vector<std::string> names;
  for (const Entry& entry : kFormats) names.emplace_back(entry.name);
  return names;
}

ProbeFormat probe_format(const std::string& name) {
  for (const Entry& entry : kFormats)
    if (name == entry.name) return entry.make();
  throw Error(ExitCode::usage, "format: found '{}', allowed: {}", name,
              fmt::join(probe_format_names(), ", "));
}

const NormalSet& probe_normals() {
  static const NormalSet kNormals = [] {
    NormalSet set;
    for (const SphericalPolygon& octant : octants()) {
      std::vector<SphericalPolygon> parts{octant};
      for (int level = 0; level < 2; ++level) {
        std::vector<SphericalPolygon> finer;
        for (const SphericalPolygon& t : parts) {
          const glm::dvec3 ab = glm::normalize(t[0] + t[1]), bc = glm::normalize(t[1] + t[2]),
                           ca = glm::normalize(t[2] + t[0]);
          for (const SphericalPolygon& part :
               {SphericalPolygon{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}})
            finer.push_back(part);
        }
        parts = std::move(finer);
      }
      for (const SphericalPolygon& t : parts) {
        set.normals.push_back(glm::normalize(t[0] + t[1] + t[2]));
        set.weights.push_back(solid_angle(t));
      }
    }
    return set;
  }();
  return kNormals;
}

double negative_share(const ProbeFormat& format, std::span<const glm::dvec3> c) {
  const std::vector<glm::dvec3>& normals = probe_normals().normals;
  const auto count = std::ranges::count_if(normals, [&](const glm::dvec3& n) {
    return glm::dot(format.irradiance(c, n), kLuminance) < 0;
  });
  return static_cast<double>(count) / static_cast<double>(normals.size());
}

Matrix of_harmonics(const ProbeFormat& format) {
  Matrix matrix(static_cast<int>(format.moments.count), 9);
  Weights g(format.moments.count);
  for (const SphericalPolygon& polygon : split(octants(), format.creases)) {
    for (const QuadratureNode& node : nodes_of(polygon)) {
      const Weights y = harmonics().evaluate(node.w);
      format.moments.weights(node.w, g);
      for (int i = 0; i < matrix.rows(); ++i)
        for (int j = 0; j < 9; ++j) matrix(i, j) += node.weight * g[i] * y[j];
    }
  }
  return matrix;
}

}  // namespace clpv::bake
