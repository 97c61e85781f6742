// SPDX-License-Identifier: MIT
// Formats of light probes: a few numbers per channel for the light that arrives at a point, and the
// irradiance that an engine makes of them (docs/bake.md, 'Formats').
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "basis/matrix.hpp"
#include "pathtracer/point_tracer.hpp"

namespace clpv::bake {

using pathtracer::Moments;

/// A format. Coefficients are red, green, blue of each number.
struct ProbeFormat {
  std::string name;
  std::size_t size = 0;  ///< numbers per channel
  std::string meaning;   ///< meaning of the numbers, with their unit
  Moments moments;       ///< integrals of arriving radiance that encode() takes
  /// Null: the integrals are the coefficients.
  std::function<std::vector<glm::dvec3>(std::span<const glm::dvec3> integrals)> encode = {};
  /// Irradiance [W/m^2] of a surface with a unit normal, negative where the format undershoots.
  std::function<glm::dvec3(std::span<const glm::dvec3> c, const glm::dvec3& normal)> irradiance;
  std::vector<glm::dvec3> creases = {};  ///< normals of planes where `moments` jump

  std::vector<glm::dvec3> encoded(std::span<const glm::dvec3> integrals) const {
    return encode ? encode(integrals) : std::vector<glm::dvec3>(integrals.begin(), integrals.end());
  }
};

/// Names of all formats, in ascending size.
std::vector<std::string> probe_format_names();
/// Throws Error(usage) for an unknown name; the message lists all.
ProbeFormat probe_format(const std::string& name);

/// 128 unit normals in equal parts of the octants, and their solid angles [sr].
struct NormalSet {
  std::vector<glm::dvec3> normals;
  std::vector<double> weights;
};
const NormalSet& probe_normals();

/// Share of probe_normals() whose irradiance has a negative luminance.
double negative_share(const ProbeFormat& format, std::span<const glm::dvec3> c);

/// Count x 9: integrals of the nine harmonics in the order of SphericalHarmonics.
Matrix of_harmonics(const ProbeFormat& format);

}  // namespace clpv::bake
