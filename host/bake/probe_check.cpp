// SPDX-License-Identifier: MIT
#include <cmath>

#include "bake/bake.hpp"
#include "basis/sampling.hpp"
#include "support/interrupt.hpp"

namespace clpv::bake {
namespace {

constexpr std::uint64_t kSurfaceSeed = 11, kAirSeed = 12;
constexpr std::size_t kTries = 64;  // places for each point

/// Random places that are not inside walls; each with the random numbers that follow.
std::vector<std::pair<glm::dvec3, Random>> places(pathtracer::PointTracer& tracer,
                                                  const ProbeGrid& grid, std::size_t count,
                                                  std::uint64_t seed) {
  std::vector<std::pair<glm::dvec3, Random>> found;
  for (std::size_t attempt = 0; found.size() < count && attempt < kTries; ++attempt) {
    std::vector<glm::dvec3> positions;
    std::vector<Random> randoms;
    for (std::size_t i = 0; i < count; ++i) {
      randoms.push_back({mix(mix(seed, attempt), i)});
      Random& random = randoms.back();
      const glm::dvec3 share(random.next(), random.next(), random.next());
      positions.push_back(grid.lower + share * (grid.upper - grid.lower));
    }
    const std::vector<std::uint8_t> valid = validity(tracer, positions);
    for (std::size_t i = 0; i < count && found.size() < count; ++i)
      if (valid[i]) found.emplace_back(positions[i], randoms[i]);
  }
  return found;
}

}  // namespace

CheckPoints given_points(pathtracer::PointTracer& tracer, std::vector<SurfacePoint> points,
                         bool direct, double& noise) {
  CheckPoints check{std::move(points), {}};
  const pathtracer::TracedPoints truth = tracer.irradiance(check.points);
  for (const pathtracer::PointLight& light : truth.points)
    check.truth.push_back(light.indirect + (direct ? light.direct : glm::dvec3(0)));
  noise = truth.noise;
  return check;
}

CheckPoints surface_points(pathtracer::PointTracer& tracer, const ProbeGrid& grid,
                           std::size_t count, bool direct, double& noise) {
  std::vector<SurfacePoint> points;
  for (std::size_t attempt = 0; points.size() < count && attempt < kTries; ++attempt) {
    for (auto& [from, random] : places(tracer, grid, count, mix(kSurfaceSeed, attempt))) {
      SurfacePoint found;
      if (points.size() == count || !tracer.hit(from, random.direction(), found)) continue;
      if (glm::all(glm::greaterThanEqual(found.position, grid.lower)) &&
          glm::all(glm::lessThanEqual(found.position, grid.upper)))
        points.push_back(found);
    }
  }
  return given_points(tracer, std::move(points), direct, noise);
}

CheckPoints air_points(pathtracer::PointTracer& tracer, const ProbeGrid& grid, std::size_t count,
                       bool direct, double& noise) {
  std::vector<SurfacePoint> points;
  for (auto& [position, random] : places(tracer, grid, count, kAirSeed)) {
    const glm::dvec3 axis = random.direction();
    const auto [u, v] = tangents_of(axis);
    const double angle = 2 * std::numbers::pi * random.next();
    const glm::dvec3 across = std::cos(angle) * u + std::sin(angle) * v,
                     other = glm::cross(axis, across);
    for (const glm::dvec3& normal : {axis, -axis, across, -across, other, -other})
      points.push_back({position, normal});
  }
  return given_points(tracer, std::move(points), direct, noise);
}

ProbeError error_of(const ProbeFormat& format, const BakedProbes& baked, const CheckPoints& points,
                    double lift) {
  double squares = 0, all = 0, sum = 0, wanted = 0;
  std::size_t negative = 0;
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    stop_if_interrupted();
    const auto& [position, normal] = points.points[i];
    const glm::dvec3 at = position + lift * baked.grid.spacing() * normal;
    const glm::dvec3 found =
        format.irradiance(interpolated(baked.grid, baked.coefficients, format.size, at), normal);
    const glm::dvec3 shown = glm::max(found, 0.0), off = shown - points.truth[i];
    negative += glm::any(glm::lessThan(found, glm::dvec3(0)));
    squares += glm::dot(off, off), all += glm::dot(points.truth[i], points.truth[i]);
    for (int c = 0; c < 3; ++c) sum += shown[c], wanted += points.truth[i][c];
  }
  const auto count = static_cast<double>(std::max<std::size_t>(points.points.size(), 1));
  return {std::sqrt(squares / all), sum / wanted, static_cast<double>(negative) / count,
          sum / (3 * count)};
}

}  // namespace clpv::bake
