// SPDX-License-Identifier: MIT
#include "reference/rasterize.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "kernels/shared/normal.h"
#include "kernels/shared/raster.h"
#include "kernels/shared/view.h"
#include "reference/lighting.hpp"
#include "reference/materials.hpp"
#include "reference/view.hpp"

namespace clpv::reference {

// A triangle projected on the screen: clipping, snapping and coverage tests, in double.

/// Coverage of pixel centres by a triangle: corners snapped to 1/256 pixel, top-left rule.
class ScreenPolygon {
 public:
  /// `corners` in world space [m]. Clipped at the near plane in perspective views.
  ScreenPolygon(const ClpvView& view, const std::array<glm::dvec3, 3>& corners);

  bool covers(unsigned px, unsigned py) const;
  /// Distance from the pixel's centre to the nearest edge [pixels].
  double distance_to_edge(unsigned px, unsigned py) const;
  /// Returns true if the front faces the viewer: counter-clockwise on the screen.
  bool faces_viewer() const { return front_; }
  double nearest() const { return nearest_; }    ///< minimum depth of its corners [m]
  double farthest() const { return farthest_; }  ///< maximum depth of its corners [m]
  bool empty() const { return corners_.empty(); }

 private:
  std::vector<glm::dvec2> corners_;  // [1/256 pixel], y down
  bool front_ = false;
  double nearest_ = 0, farthest_ = 0;
};

namespace {

double depth_of(const ClpvView& view, const glm::dvec3& p) {
  double depth = 0;
  for (int i = 0; i < 3; ++i) depth += (p[i] - view.eye[i]) * view.forward[i];
  return depth;
}

/// Clips the triangle at the near plane; returns a polygon.
std::vector<glm::dvec3> clipped(const ClpvView& view, const std::array<glm::dvec3, 3>& corners) {
  if (view.orthographic != 0) return {corners.begin(), corners.end()};
  std::vector<glm::dvec3> polygon;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 &a = corners[i], &b = corners[(i + 1) % 3];
    const double da = depth_of(view, a) - view.near_depth, db = depth_of(view, b) - view.near_depth;
    if (da >= 0) polygon.push_back(a);
    if ((da >= 0) != (db >= 0)) polygon.push_back(a + (b - a) * (da / (da - db)));
  }
  return polygon;
}

glm::dvec2 centre(unsigned px, unsigned py) {
  return (glm::dvec2(px, py) + 0.5) * static_cast<double>(CLPV_SUBPIXELS);
}

/// Returns true if the point is left of the edge from a to b, or on it if it is a top or left edge.
/// For triangles that are clockwise on the screen (y down).
bool inside_edge(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& point) {
  const double side = cross(b - a, point - a);
  const bool top_left = b.y < a.y || (b.y == a.y && b.x > a.x);
  return side > 0 || (side == 0 && top_left);
}

bool inside_triangle(glm::dvec2 a, glm::dvec2 b, const glm::dvec2& c, const glm::dvec2& point) {
  const double area = cross(b - a, c - a);
  if (area == 0) return false;
  if (area < 0) std::swap(a, b);
  return inside_edge(a, b, point) && inside_edge(b, c, point) && inside_edge(c, a, point);
}

double distance_to_segment(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& point) {
  const glm::dvec2 along = b - a;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0 ? std::clamp(glm::dot(point - a, along) / length2, 0.0, 1.0) : 0.0;
  return glm::length(point - (a + t * along));
}

}  // namespace

ScreenPolygon::ScreenPolygon(const ClpvView& view, const std::array<glm::dvec3, 3>& corners) {
  nearest_ = std::numeric_limits<double>::max();
  farthest_ = std::numeric_limits<double>::lowest();
  for (const glm::dvec3& corner : clipped(view, corners)) {
    const ProjectedPoint projected = project(view, corner);
    const glm::dvec2 at = (projected.pixel + 0.5) * static_cast<double>(CLPV_SUBPIXELS);
    corners_.emplace_back(std::nearbyint(at.x), std::nearbyint(at.y));
    nearest_ = std::min(nearest_, projected.depth);
    farthest_ = std::max(farthest_, projected.depth);
  }
  double area = 0;
  for (std::size_t i = 0; i < corners_.size(); ++i)
    area += cross(corners_[i], corners_[(i + 1) % corners_.size()]);
  front_ = area < 0;  // y points down
}

bool ScreenPolygon::covers(unsigned px, unsigned py) const {
  for (std::size_t i = 2; i < corners_.size(); ++i) {
    if (inside_triangle(corners_[0], corners_[i - 1], corners_[i], centre(px, py))) return true;
  }
  return false;
}

double ScreenPolygon::distance_to_edge(unsigned px, unsigned py) const {
  double smallest = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    smallest = std::min(
        smallest,
        distance_to_segment(corners_[i], corners_[(i + 1) % corners_.size()], centre(px, py)));
  }
  return smallest / int{CLPV_SUBPIXELS};
}

namespace {

// Tolerances below which rounding may change a pixel.
constexpr double kEdgeTolerance = 1.0 / 64;  // [pixel]
constexpr double kDepthTolerance = 1e-5;     // relative depth
constexpr double kCutoffTolerance = 1e-3;    // alpha
constexpr double kEdgeOnTolerance = 1e-4;    // cosine between ray and plane
constexpr double kLargestWeight = 10;        // resolve.cl

/// Step along a pixel's ray that increases depth by 1 m.
glm::dvec3 along(const ClpvView& view, unsigned px, unsigned py) {
  return surface_position(view, px, py, 1) - surface_position(view, px, py, 0);
}

/// A triangle of the scene with its plane and its polygon on the screen.
class Candidate {
 public:
  Candidate(const SceneData& scene, const ClpvView& view, std::uint32_t index)
      : index_(index),
        corners_(corners_of(scene, scene.triangles[index])),
        polygon_(view, corners_) {
    normal_ = glm::cross(corners_[1] - corners_[0], corners_[2] - corners_[0]);
  }

  const ScreenPolygon& polygon() const { return polygon_; }
  const glm::dvec3& normal() const { return normal_; }

  /// Depth of its plane at a pixel, clamped to the range of its corners.
  double depth(const ClpvView& view, unsigned px, unsigned py) const {
    const glm::dvec3 start = surface_position(view, px, py, 0);
    const double depth =
        glm::dot(normal_, corners_[0] - start) / glm::dot(normal_, along(view, px, py));
    if (!std::isfinite(depth)) return polygon_.nearest();
    return std::clamp(depth, polygon_.nearest(), polygon_.farthest());
  }

  /// Point of the triangle at a pixel and depth.
  SurfacePoint point(const ClpvView& view, unsigned px, unsigned py, double depth) const {
    const glm::dvec3 offset = surface_position(view, px, py, depth) - corners_[0];
    const glm::dvec3 ab = corners_[1] - corners_[0], ac = corners_[2] - corners_[0];
    const double area2 = glm::dot(normal_, normal_);
    if (area2 == 0) return {index_, glm::vec2(0)};
    const double second = std::clamp(glm::dot(offset, glm::cross(ac, normal_)) / area2, 0.0, 1.0);
    const double third =
        std::clamp(glm::dot(offset, glm::cross(normal_, ab)) / area2, 0.0, 1.0 - second);
    return {index_, glm::vec2(second, third)};
  }

  bool edge_on(const ClpvView& view, unsigned px, unsigned py) const {
    const glm::dvec3 ray = along(view, px, py);
    return std::abs(glm::dot(normal_, ray)) <=
           kEdgeOnTolerance * glm::length(normal_) * glm::length(ray);
  }

 private:
  std::uint32_t index_;
  std::array<glm::dvec3, 3> corners_;
  ScreenPolygon polygon_;
  glm::dvec3 normal_{0};
};

/// Nearest candidate at a pixel.
struct Hit {
  const Candidate* candidate = nullptr;
  double depth = std::numeric_limits<double>::infinity();
  bool uncertain = false;
};

/// All candidates of a view.
class ViewedScene {
 public:
  ViewedScene(const SceneData& scene, const ClpvView& view, bool cull_back_faces)
      : view_(view), materials_(scene) {
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
      Candidate candidate(scene, view, i);
      const unsigned flags = scene.materials[scene.triangles[i].material].flags;
      const bool culled = cull_back_faces && !candidate.polygon().faces_viewer() &&
                          !(flags & CLPV_MATERIAL_DOUBLE_SIDED);
      if (!candidate.polygon().empty() && !culled) candidates_.push_back(std::move(candidate));
    }
  }

  const Materials& materials() const { return materials_; }

  Hit hit(unsigned px, unsigned py) const {
    Hit hit;
    for (const Candidate& candidate : candidates_) consider(candidate, px, py, hit);
    for (const Candidate& candidate : candidates_) {
      if (is_uncertain(candidate, px, py, hit)) hit.uncertain = true;
    }
    return hit;
  }

 private:
  double solidity(const Candidate& candidate, unsigned px, unsigned py, double depth) const {
    return materials_.solidity(candidate.point(view_, px, py, depth));
  }

  void consider(const Candidate& candidate, unsigned px, unsigned py, Hit& hit) const {
    if (!candidate.polygon().covers(px, py)) return;
    const double depth = candidate.depth(view_, px, py);
    if (depth > view_.far_depth || depth >= hit.depth) return;  // the first of equal depths wins
    if (solidity(candidate, px, py, depth) < 0) return;
    hit.candidate = &candidate;
    hit.depth = depth;
  }

  /// Returns true if a small error could make this candidate visible, or hide it if it is visible.
  bool is_uncertain(const Candidate& candidate, unsigned px, unsigned py, const Hit& hit) const {
    const double edge = candidate.polygon().distance_to_edge(px, py);
    if (edge > kEdgeTolerance && !candidate.polygon().covers(px, py)) return false;
    const double depth = candidate.depth(view_, px, py);
    if (depth > hit.depth * (1 + kDepthTolerance)) return false;
    const bool edge_close = edge <= kEdgeTolerance;
    const bool depth_close = depth != hit.depth && depth > hit.depth * (1 - kDepthTolerance);
    return edge_close || depth_close || candidate.edge_on(view_, px, py) ||
           std::abs(solidity(candidate, px, py, depth)) < kCutoffTolerance;
  }

  const ClpvView& view_;
  Materials materials_;
  std::vector<Candidate> candidates_;
};

/// Unit normals on the visible side of a triangle.
struct Normals {
  glm::dvec3 shading, geometric;
};

/// The interpolated normal, and the triangle's (CLPV_SAME_NORMAL: the interpolated one).
Normals visible_normals(const SceneData& scene, const Candidate& candidate,
                        const SurfacePoint& point, const glm::dvec3& ray) {
  const glm::dvec3 front =
      glm::dot(candidate.normal(), ray) > 0 ? -candidate.normal() : candidate.normal();
  glm::dvec3 blended(interpolate(scene, scene.triangles[point.triangle], point.weights, normal));
  if (blended == glm::dvec3(0)) blended = front;
  const glm::dvec3 shading = glm::normalize(glm::dot(blended, front) < 0 ? -blended : blended);
  const bool apart = glm::length(front) > 0 &&
                     glm::dot(glm::normalize(front), shading) <= double{CLPV_SAME_NORMAL};
  return {shading, apart ? glm::normalize(front) : shading};
}

/// (n_s . towards) / (n_g . towards), bounded: light on the surface over that on its triangle.
double light_weight(const Normals& normals, const glm::dvec3& towards) {
  if (normals.shading == normals.geometric) return 1;
  const double shading = glm::dot(normals.shading, towards),
               geometric = glm::dot(normals.geometric, towards);
  return shading > 0 && geometric > 0 ? std::min(shading / geometric, kLargestWeight) : 0;
}

/// Footprint of a pixel on the triangle's plane.
Footprint pixel_footprint(const ClpvView& view, const Candidate& candidate, const glm::dvec3& ray,
                          double depth) {
  const double scale = view.orthographic != 0 ? 1 : depth;
  const auto on_plane = [&](const glm::dvec3& across) {
    return across -
           ray * (glm::dot(candidate.normal(), across) / glm::dot(candidate.normal(), ray));
  };
  return {on_plane(vector(view.right) * (scale * 2 * view.half_width / view.width)),
          on_plane(vector(view.up) * (scale * -2 * view.half_height / view.height))};
}

/// Renders a view; colour(albedo, normals, px, py, depth) returns the image's colour.
template <typename Colour>
RasterizedImage rasterize(const SceneData& scene, const ClpvView& view, bool camera,
                          Colour colour) {
  const ViewedScene viewed(scene, view, camera);
  const std::size_t count = static_cast<std::size_t>(view.width) * view.height;
  RasterizedImage out;
  SurfaceImage& image = out.image;
  image.view = view;
  image.depth.resize(count);
  image.normal.resize(count, glm::vec4(0));
  image.colour.resize(count, glm::vec4(0));
  if (camera) image.emissive.resize(count, glm::vec4(0));
  for (unsigned py = 0; py < view.height; ++py) {
    for (unsigned px = 0; px < view.width; ++px) {
      const std::size_t at = static_cast<std::size_t>(py) * view.width + px;
      const Hit hit = viewed.hit(px, py);
      out.uncertain.push_back(hit.uncertain);
      if (hit.candidate == nullptr) continue;
      const SurfacePoint point = hit.candidate->point(view, px, py, hit.depth);
      const glm::dvec3 ray = along(view, px, py);
      const Footprint footprint = pixel_footprint(view, *hit.candidate, ray, hit.depth);
      const double depth = std::max<double>(hit.depth, view.near_depth);
      image.depth[at] = depth;
      const Normals normals = visible_normals(scene, *hit.candidate, point, ray);
      image.normal[at] = camera ? stored_normal(normals.shading, normals.geometric)
                                : glm::vec4(glm::vec3(normals.geometric), 0);
      image.colour[at] = glm::vec4(
          colour(glm::dvec3(viewed.materials().albedo(point, footprint)), normals, px, py, depth),
          0);
      if (camera) image.emissive[at] = glm::vec4(viewed.materials().emissive(point, footprint), 0);
    }
  }
  return out;
}

}  // namespace

RasterizedImage rasterize_camera(const SceneData& scene, const ClpvView& view) {
  return rasterize(scene, view, true,
                   [](const glm::dvec3& albedo, const Normals&, unsigned, unsigned, double) {
                     return glm::vec3(albedo);
                   });
}

RasterizedImage rasterize_rsm(const SceneData& scene, const ClpvLight& light,
                              const ClpvView& view) {
  return rasterize(scene, view, false,
                   [&](const glm::dvec3& albedo, const Normals& normals, unsigned px, unsigned py,
                       double depth) {
                     const Incident in = light_at(light, surface_position(view, px, py, depth));
                     return glm::vec3(albedo * in.irradiance * light_weight(normals, in.towards) *
                                      footprint(view, px, py, depth));
                   });
}

}  // namespace clpv::reference
