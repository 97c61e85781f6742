// SPDX-License-Identifier: MIT
#include "basis/lobe_aims.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "basis/clamped_cosine.hpp"
#include "basis/transport.hpp"
#include "support/error.hpp"
#include "support/input_file.hpp"
#include "support/json_schema.hpp"

namespace clpv {
namespace {

using nlohmann::json;

using std::numbers::pi;
constexpr double kCosineNorm = 2 * pi / 3;  // Int max(0, w . d)^2 dw
constexpr std::size_t kMaxWeights = 10000;  // bounds a search's run time

WeightedDirection weighted_direction(const json& entry, const std::string& path, std::size_t index) {
  const bool four = entry.is_array() && entry.size() == 4 &&
                    std::ranges::all_of(entry, [](const json& number) { return number.is_number(); });
  if (four) {
    const glm::dvec3 v(entry[0].get<double>(), entry[1].get<double>(), entry[2].get<double>());
    const double weight = entry[3].get<double>(), length = glm::length(v);
    if (std::isfinite(length) && length > 0 && std::isfinite(weight) && weight > 0)
      return {v / length, weight};
  }
  throw Error(ExitCode::bad_input,
              "{}: /weights/{}: found {}; allowed: [x, y, z, weight], a direction and a weight above 0", path,
              index, quoted(entry));
}

}  // namespace

LobeAims all_directions() {
  return {"all directions", {}};
}

LobeAims propagation_axes() {
  LobeAims aims{"the six axes", {}};
  for (const glm::ivec3& axis : kAxes)
    aims.directions.push_back({glm::dvec3(axis), 1.0 / static_cast<double>(kAxes.size())});
  return aims;
}

LobeAims load_aims(const std::string& path) {
  const json file = read_json(path, kMaxFileBytes);
  const auto found = file.is_object() ? file.find("weights") : file.end();
  if (found == file.end() || !found->is_array() || found->empty() || found->size() > kMaxWeights) {
    throw Error(ExitCode::bad_input, "{}: /weights: allowed: an array of 1 to {} entries [x, y, z, weight]",
                path, kMaxWeights);
  }
  LobeAims aims{path, {}};
  double sum = 0;
  for (const json& entry : *found) {
    aims.directions.push_back(weighted_direction(entry, path, aims.directions.size()));
    sum += aims.directions.back().weight;
  }
  if (!std::isfinite(sum))
    throw Error(ExitCode::bad_input, "{}: /weights: found a sum of {}; allowed: a finite sum", path, sum);
  for (WeightedDirection& direction : aims.directions) direction.weight /= sum;
  return aims;
}

double relative_l2(const Basis& basis, std::span<const double> c, const glm::dvec3& d) {
  std::vector<double> alpha(c.size());
  basis.cosine_integrals(d, alpha);
  return std::sqrt(std::max(0.0, kCosineNorm + dot(c, basis.gram() * c) - 2 * dot(c, alpha)) / kCosineNorm);
}

std::vector<glm::dvec3> even_directions(int count) {
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, radius = std::sqrt(1 - z * z);
    const double azimuth = pi * (3 - std::sqrt(5.0)) * i;
    directions.emplace_back(radius * std::cos(azimuth), radius * std::sin(azimuth), z);
  }
  return directions;
}

double error_over(const Basis& basis, const LobeAims& aims) {
  std::vector<WeightedDirection> directions = aims.directions;
  if (directions.empty()) {
    for (const glm::dvec3& d : even_directions(kEvenDirections))
      directions.push_back({d, 1.0 / kEvenDirections});
  }
  double sum = 0;
  for (const auto& [d, weight] : directions)
    sum += weight * std::pow(relative_l2(basis, basis.clamped_cosine(d), d), 2);
  return std::sqrt(sum);
}

double minimum_error(int functions) {
  // Each of the 2 l + 1 functions of band l represents A_l^2 / 4 pi of the square norm, which decreases with l.
  double rest = kCosineNorm;
  for (int band = 0; functions > 0; ++band) {
    const double each = std::pow(cosine_band(band), 2) / (4 * pi);
    if (each == 0) continue;  // odd bands above 1 contribute nothing
    const int taken = std::min(functions, 2 * band + 1);
    rest -= taken * each;
    functions -= taken;
  }
  return std::sqrt(std::max(0.0, rest) / kCosineNorm);
}

}  // namespace clpv
