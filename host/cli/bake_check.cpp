// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/bake_parts.hpp"
#include "support/log.hpp"

namespace clpv::bake_command {
namespace {

/// '-' for what is unknown.
std::string decimal(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

/// Says why errors are unknown.
void say_unknown(const char* where, const CheckPoints& points) {
  if (points.points.empty()) {
    log_warning("no points {} within the bounds that are not inside walls: errors there are '-'",
                where);
  } else if (std::ranges::all_of(points.truth,
                                 [](const glm::dvec3& e) { return e == glm::dvec3(0); })) {
    log_warning("the truth {} is dark: relative errors there are '-'", where);
  }
}

std::string given_row(const std::string& name, const std::string& numbers, const std::string& bytes,
                      double mean, double nrmse) {
  return fmt::format("{:<18}{:>8}{:>7}{:>12.5g}{:>9}\n", name, numbers, bytes, mean,
                     decimal(100 * nrmse, 1));
}

}  // namespace

Check::Check(const Options& options, pathtracer::PointTracer& tracer, const ProbeGrid& grid,
             std::vector<SurfacePoint> given)
    : given_(!given.empty()) {
  if (given_) {
    surfaces_ = given_points(tracer, std::move(given), options.direct, noise_[0]);
  } else {
    surfaces_ = surface_points(tracer, grid, options.check, options.direct, noise_[0]);
    air_ = air_points(tracer, grid, options.check, options.direct, noise_[1]);
  }
}

std::string Check::header() const {
  if (!given_)
    return fmt::format("{:<18}{:>8}{:>7}{:>10}{:>9}{:>9}{:>9}{:>11}\n", "format", "numbers",
                       "bytes", "surface %", "energy", "air %", "energy", "negative %");
  glm::dvec3 sum(0);
  for (const glm::dvec3& light : surfaces_.truth) sum += light;
  return fmt::format("{:<18}{:>8}{:>7}{:>12}{:>9}\n", "format", "numbers", "bytes", "mean W/m^2",
                     "error %") +
         given_row("truth", "", "",
                   (sum.x + sum.y + sum.z) / 3 / static_cast<double>(surfaces_.truth.size()), 0);
}

std::string Check::row(const ProbeFormat& format, const BakedProbes& baked) const {
  const ProbeError on = error_of(format, baked, surfaces_, kSurfaceLift);
  if (given_)
    return given_row(format.name, std::to_string(format.size), std::to_string(6 * format.size),
                     on.mean, on.nrmse);
  const ProbeError off = error_of(format, baked, air_, 0);
  return fmt::format("{:<18}{:>8}{:>7}{:>10}{:>9}{:>9}{:>9}{:>11.1f}\n", format.name, format.size,
                     6 * format.size, decimal(100 * on.nrmse, 1), decimal(on.energy, 3),
                     decimal(100 * off.nrmse, 1), decimal(off.energy, 3), 100 * off.negative);
}

nlohmann::json Check::error(const ProbeFormat& format, const BakedProbes& baked) const {
  const auto described = [&](const CheckPoints& points, std::size_t normals, double lift,
                             double noise) {
    const ProbeError error = error_of(format, baked, points, lift);
    return nlohmann::json{{"points", points.points.size() / normals},
                          {"nrmse", number(error.nrmse)},
                          {"energy", number(error.energy)},
                          {"negative", error.negative},
                          {"truth_noise", number(noise)}};
  };
  return {{"surfaces", described(surfaces_, 1, kSurfaceLift, noise_[0])},
          {"air", described(air_, 6, 0, noise_[1])}};
}

void Check::report(const ProbeGrid& grid) const {
  const glm::dvec3 spacing = grid.spacing();
  log_info("{} x {} x {} probes, {:.3g} x {:.3g} x {:.3g} m apart", grid.count.x, grid.count.y,
           grid.count.z, spacing.x, spacing.y, spacing.z);
  if (given_) {
    log_info("{} points, noise {}", surfaces_.points.size(), decimal(noise_[0], 4));
    const auto far = std::ranges::count_if(
        surfaces_.points, [&](const SurfacePoint& point) { return grid.is_far(point.position); });
    if (far > 0)
      log_warning(
          "{} of {} points lie more than half a spacing outside the probes, which have only the "
          "light of their border there; --bounds decides",
          far, surfaces_.points.size());
    return;
  }
  log_info("{} points of surfaces and {} in the air, noise {} and {}", surfaces_.points.size(),
           air_.points.size() / 6, decimal(noise_[0], 4), decimal(noise_[1], 4));
  say_unknown("on surfaces", surfaces_);
  say_unknown("in the air", air_);
}

}  // namespace clpv::bake_command
