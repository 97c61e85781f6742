// SPDX-License-Identifier: MIT
// Errors of baked probes against path tracing, on surfaces and in the air.
#pragma once

#include <string>
#include <vector>

#include "bake/bake.hpp"
#include "scene/input.hpp"

namespace clpv::bake {

/// Random places in a grid that are not inside walls, and their true irradiance [W/m^2].
struct CheckPoints {
  std::vector<SurfacePoint> points;
  std::vector<glm::dvec3> truth;
};

/// `count` points of surfaces that are seen from such places; or `count` such places with six
/// normals each, along the axes of a random rotation. `direct`: with light of the scene's lights.
/// Fewer where most of the grid is inside walls.
CheckPoints surface_points(pathtracer::PointTracer& tracer, const ProbeGrid& grid,
                           std::size_t count, bool direct, double& noise);
CheckPoints air_points(pathtracer::PointTracer& tracer, const ProbeGrid& grid, std::size_t count,
                       bool direct, double& noise);

/// The points of a file.
CheckPoints given_points(pathtracer::PointTracer& tracer, std::vector<SurfacePoint> points,
                         bool direct, double& noise);

/// Errors over all points and channels.
struct ProbeError {
  double nrmse = 0;     ///< root mean square error over that of the truth; NaN in the dark
  double energy = 0;    ///< sum over that of the truth; NaN in the dark
  double negative = 0;  ///< share of points with a negative channel, which count as 0
  double mean = 0;      ///< irradiance [W/m^2], over all points and channels
};

/// `lift`: look-ups lie so many spacings along the normal.
ProbeError error_of(const ProbeFormat& format, const BakedProbes& baked, const CheckPoints& points,
                    double lift);

/// The lift on surfaces, three.js's.
inline constexpr double kSurfaceLift = 0.5;

}  // namespace clpv::bake
