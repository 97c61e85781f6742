// SPDX-License-Identifier: MIT
#include "reference/rasterize.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/lighting.hpp"
#include "reference/materials.hpp"
#include "reference/screen_polygon.hpp"
#include "reference/triangle.hpp"
#include "reference/view.hpp"

namespace clpv::reference {
namespace {

constexpr double kEdgeDoubt = 1.0 / 64;  // [pixel]
constexpr double kDepthDoubt = 1e-5;     // of the depth
constexpr double kAlphaDoubt = 1e-3;
constexpr double kEdgeOnDoubt = 1e-4;  // cosine between ray and plane

/// Along a pixel's ray, one metre deeper.
glm::dvec3 along(const ClpvView& view, unsigned px, unsigned py) {
  return surface_position(view, px, py, 1) - surface_position(view, px, py, 0);
}

/// A triangle of the scene, its plane and what of it the screen shows.
class Candidate {
 public:
  Candidate(const Scene& scene, const ClpvView& view, std::uint32_t index)
      : index_(index), corners_(corners_of(scene, scene.triangles[index])), polygon_(view, corners_) {
    normal_ = glm::cross(corners_[1] - corners_[0], corners_[2] - corners_[0]);
  }

  const ScreenPolygon& polygon() const { return polygon_; }
  const glm::dvec3& normal() const { return normal_; }

  /// The depth of its plane behind a pixel, no farther out than its corners are.
  double depth(const ClpvView& view, unsigned px, unsigned py) const {
    const glm::dvec3 start = surface_position(view, px, py, 0);
    const double depth = glm::dot(normal_, corners_[0] - start) / glm::dot(normal_, along(view, px, py));
    if (!std::isfinite(depth)) return polygon_.nearest();
    return std::clamp(depth, polygon_.nearest(), polygon_.farthest());
  }

  /// The point of the triangle at a depth behind a pixel.
  SurfacePoint point(const ClpvView& view, unsigned px, unsigned py, double depth) const {
    const glm::dvec3 offset = surface_position(view, px, py, depth) - corners_[0];
    const glm::dvec3 ab = corners_[1] - corners_[0], ac = corners_[2] - corners_[0];
    const double area2 = glm::dot(normal_, normal_);
    if (area2 == 0) return {index_, glm::vec2(0)};
    const double second = std::clamp(glm::dot(offset, glm::cross(ac, normal_)) / area2, 0.0, 1.0);
    const double third = std::clamp(glm::dot(offset, glm::cross(normal_, ab)) / area2, 0.0, 1.0 - second);
    return {index_, glm::vec2(second, third)};
  }

  bool edge_on(const ClpvView& view, unsigned px, unsigned py) const {
    const glm::dvec3 ray = along(view, px, py);
    return std::abs(glm::dot(normal_, ray)) <= kEdgeOnDoubt * glm::length(normal_) * glm::length(ray);
  }

 private:
  std::uint32_t index_;
  std::array<glm::dvec3, 3> corners_;
  ScreenPolygon polygon_;
  glm::dvec3 normal_{0};
};

/// What a pixel sees: the nearest of the candidates, and whether that is a close call.
struct Visible {
  const Candidate* seen = nullptr;
  double depth = std::numeric_limits<double>::infinity();
  bool doubtful = false;
};

class Eye {
 public:
  Eye(const Scene& scene, const ClpvView& view, bool cull_back_faces) : view_(view), materials_(scene) {
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
      Candidate candidate(scene, view, i);
      const unsigned flags = scene.materials[scene.triangles[i].material].flags;
      const bool culled =
          cull_back_faces && !candidate.polygon().faces_viewer() && !(flags & CLPV_MATERIAL_DOUBLE_SIDED);
      if (!candidate.polygon().empty() && !culled) candidates_.push_back(std::move(candidate));
    }
  }

  const Materials& materials() const { return materials_; }

  Visible look(unsigned px, unsigned py) const {
    Visible visible;
    for (const Candidate& candidate : candidates_) consider(candidate, px, py, visible);
    for (const Candidate& candidate : candidates_) {
      if (is_close_call(candidate, px, py, visible)) visible.doubtful = true;
    }
    return visible;
  }

 private:
  double solidity(const Candidate& candidate, unsigned px, unsigned py, double depth) const {
    return materials_.solidity(candidate.point(view_, px, py, depth));
  }

  void consider(const Candidate& candidate, unsigned px, unsigned py, Visible& visible) const {
    if (!candidate.polygon().covers(px, py)) return;
    const double depth = candidate.depth(view_, px, py);
    if (depth > view_.far_depth || depth >= visible.depth) return;  // of equals the first stays
    if (solidity(candidate, px, py, depth) < 0) return;
    visible.seen = &candidate;
    visible.depth = depth;
  }

  /// Whether a small error could make this candidate, not in front of what is seen, take its place, or lose it.
  bool is_close_call(const Candidate& candidate, unsigned px, unsigned py, const Visible& visible) const {
    const double edge = candidate.polygon().distance_to_edge(px, py);
    if (edge > kEdgeDoubt && !candidate.polygon().covers(px, py)) return false;
    const double depth = candidate.depth(view_, px, py);
    if (depth > visible.depth * (1 + kDepthDoubt)) return false;
    const bool edge_close = edge <= kEdgeDoubt && &candidate != visible.seen;
    const bool depth_close = depth != visible.depth && depth > visible.depth * (1 - kDepthDoubt);
    const bool own_edge = edge <= kEdgeDoubt && &candidate == visible.seen;
    return edge_close || own_edge || depth_close || candidate.edge_on(view_, px, py) ||
           std::abs(solidity(candidate, px, py, depth)) < kAlphaDoubt;
  }

  const ClpvView& view_;
  Materials materials_;
  std::vector<Candidate> candidates_;
};

/// The interpolated normal, unit, on the side of the triangle that is seen.
glm::dvec3 seen_normal(const Scene& scene, const Candidate& seen, const SurfacePoint& point,
                       const glm::dvec3& ray) {
  const glm::dvec3 front = glm::dot(seen.normal(), ray) > 0 ? -seen.normal() : seen.normal();
  glm::dvec3 blended(interpolate(scene, scene.triangles[point.triangle], point.weights, normal));
  if (blended == glm::dvec3(0)) blended = front;
  return glm::normalize(glm::dot(blended, front) < 0 ? -blended : blended);
}

/// How far the point moves on the triangle's plane from pixel to pixel.
Footprint pixel_footprint(const ClpvView& view, const Candidate& seen, const glm::dvec3& ray, double depth) {
  const double scale = view.orthographic != 0 ? 1 : depth;
  const auto on_plane = [&](const glm::dvec3& across) {
    return across - ray * (glm::dot(seen.normal(), across) / glm::dot(seen.normal(), ray));
  };
  return {on_plane(vector(view.right) * (scale * 2 * view.half_width / view.width)),
          on_plane(vector(view.up) * (scale * -2 * view.half_height / view.height))};
}

/// Fills a surface; `colour(albedo, px, py, depth)` makes of the albedo what the surface's colour is.
template <typename Colour>
Rasterized rasterize(const Scene& scene, const ClpvView& view, bool camera, Colour colour) {
  const Eye eye(scene, view, camera);
  const std::size_t count = static_cast<std::size_t>(view.width) * view.height;
  Rasterized out;
  SurfaceImage& image = out.image;
  image.view = view;
  image.depth.resize(count);
  image.normal.resize(count, glm::vec4(0));
  image.colour.resize(count, glm::vec4(0));
  if (camera) image.emissive.resize(count, glm::vec4(0));
  for (unsigned py = 0; py < view.height; ++py) {
    for (unsigned px = 0; px < view.width; ++px) {
      const std::size_t at = static_cast<std::size_t>(py) * view.width + px;
      const Visible visible = eye.look(px, py);
      out.doubtful.push_back(visible.doubtful);
      if (visible.seen == nullptr) continue;
      const SurfacePoint point = visible.seen->point(view, px, py, visible.depth);
      const glm::dvec3 ray = along(view, px, py);
      const Footprint footprint = pixel_footprint(view, *visible.seen, ray, visible.depth);
      const double depth = std::max<double>(visible.depth, view.near_depth);
      image.depth[at] = depth;
      image.normal[at] = glm::vec4(glm::vec3(seen_normal(scene, *visible.seen, point, ray)), 0);
      image.colour[at] =
          glm::vec4(colour(glm::dvec3(eye.materials().albedo(point, footprint)), px, py, depth), 0);
      if (camera) image.emissive[at] = glm::vec4(eye.materials().emissive(point, footprint), 0);
    }
  }
  return out;
}

}  // namespace

Rasterized rasterize_camera(const Scene& scene, const ClpvView& view) {
  return rasterize(scene, view, true,
                   [](const glm::dvec3& albedo, unsigned, unsigned, double) { return glm::vec3(albedo); });
}

Rasterized rasterize_rsm(const Scene& scene, const ClpvLight& light, const ClpvView& view) {
  return rasterize(scene, view, false, [&](const glm::dvec3& albedo, unsigned px, unsigned py, double depth) {
    const glm::dvec3 irradiance = light_at(light, surface_position(view, px, py, depth)).irradiance;
    return glm::vec3(albedo * irradiance * footprint(view, px, py, depth));
  });
}

}  // namespace clpv::reference
