// SPDX-License-Identifier: MIT
#include "pipeline/raster/view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "kernels/shared/raster.h"
#include "scene/scene.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr double kLightNear = 0.01;       // [m]; a lamp's own glass may be this close
constexpr double kSmallestMargin = 0.01;  // [m] between an orthographic eye and the nearest surface
constexpr double kRelativeMargin = 1e-3;  // the same, relative to the scene's depth
constexpr float kMargin = 4e-5f;          // relative rounding of distances from the eye, here too
constexpr int kMaxCubes = 64;             // cubes of light_bounds()
constexpr int kGapCubes = 3;              // empty ones that are a gap

struct Axes {
  glm::dvec3 right, up, forward;
};

/// Axes with right x up = -forward; `up` is the direction nearest to `upwards`.
Axes axes(const glm::dvec3& forward, const glm::dvec3& upwards) {
  const glm::dvec3 right = glm::normalize(glm::cross(forward, upwards));
  return {right, glm::cross(right, forward), forward};
}

/// Axes across a light's direction; `upwards` is the world axis least aligned with it.
Axes light_axes(const glm::dvec3& direction) {
  const glm::dvec3 size = glm::abs(direction);
  glm::dvec3 upwards(0, 0, 1);
  if (size.y <= size.x && size.y <= size.z) upwards = {0, 1, 0};
  if (size.x < size.y && size.x < size.z) upwards = {1, 0, 0};
  return axes(direction, upwards);
}

void store(float out[3], const glm::dvec3& v) {
  for (int i = 0; i < 3; ++i) out[i] = v[i];
}

ClpvView make_view(const Axes& axes, const glm::dvec3& eye, int width, int height) {
  ClpvView view{};
  store(view.eye, eye);
  store(view.right, axes.right);
  store(view.up, axes.up);
  store(view.forward, axes.forward);
  view.width = width;
  view.height = height;
  return view;
}

/// Returns the range of depths of a box along `forward`.
glm::dvec2 span_along(const Bounds& bounds, const glm::dvec3& axis) {
  const glm::dvec3 centre = 0.5 * (glm::dvec3(bounds.lower) + glm::dvec3(bounds.upper));
  const glm::dvec3 half = 0.5 * (glm::dvec3(bounds.upper) - glm::dvec3(bounds.lower));
  const double middle = glm::dot(centre, axis), reach = glm::dot(half, glm::abs(axis));
  return {middle - reach, middle + reach};
}

/// Returns an orthographic view centred at (x, y) of the plane across the light, with the depths of
/// `bounds`.
ClpvView orthographic_view(const Axes& axes, double x, double y, double half_width,
                           double half_height, const Bounds& bounds, int size) {
  const glm::dvec2 depths = span_along(bounds, axes.forward);
  const double margin = kSmallestMargin + kRelativeMargin * (depths.y - depths.x);
  ClpvView view = make_view(axes, x * axes.right + y * axes.up + (depths.x - margin) * axes.forward,
                            size, size);
  view.orthographic = 1;
  view.half_width = half_width;
  view.half_height = half_height;
  view.near_depth = 0.5 * margin;
  view.far_depth = depths.y - depths.x + 2 * margin;
  return view;
}

ClpvView perspective_light_view(const Axes& axes, const ClpvLight& light, double tangent, int size,
                                const Bounds& bounds) {
  const glm::dvec3 eye = vector(light.position);
  const glm::dvec3 reach =
      glm::max(glm::abs(glm::dvec3(bounds.lower) - eye), glm::abs(glm::dvec3(bounds.upper) - eye));
  double farthest = glm::length(reach);
  if (light.range > 0) farthest = std::min(farthest, static_cast<double>(light.range));
  ClpvView view = make_view(axes, eye, size, size);
  view.half_width = view.half_height = tangent;
  view.near_depth = kLightNear;
  view.far_depth = std::max(farthest * (1 + kRelativeMargin), 2 * kLightNear);
  return view;
}

/// Outer half-angle [rad] of a spot light.
double outer_angle(const ClpvLight& light) {
  if (light.cone_scale <= 0) return 3.14159265358979;  // no cone: lit in all directions
  return cone_of(light).outer;
}

bool too_wide_for_one_view(const ClpvLight& spot) {
  return outer_angle(spot) > kWidestSpotView * (1 + 1e-4);
}

ClpvView directional_shadow_view(const ClpvLight& light, const Bounds& bounds, int size) {
  const Axes frame = light_axes(glm::normalize(vector(light.direction)));
  const glm::dvec2 across = span_along(bounds, frame.right), along = span_along(bounds, frame.up);
  // One texel around the scene, for filters that read neighbours.
  const double spare = 1 + 2.0 / size;
  return orthographic_view(frame, 0.5 * (across.x + across.y), 0.5 * (along.x + along.y),
                           std::max(0.5 * spare * (across.y - across.x), kSmallestMargin),
                           std::max(0.5 * spare * (along.y - along.x), kSmallestMargin), bounds,
                           size);
}

/// Half-space of the points p, relative to a view's eye, with along . p + offset >= 0.
struct Plane {
  glm::dvec3 along;
  double offset;
};

/// Half-spaces that contain all between the sides of a view, which are `width` and `height` from
/// its axis (orthographic: [m], perspective: at a depth of 1).
std::vector<Plane> sides(const ClpvView& view, double width, double height) {
  const glm::dvec3 right = vector(view.right), up = vector(view.up), forward = vector(view.forward);
  const bool parallel = view.orthographic != 0;
  const glm::dvec3 wider = parallel ? glm::dvec3(0) : width * forward,
                   higher = parallel ? glm::dvec3(0) : height * forward;
  const double beside = parallel ? width : 0, above = parallel ? height : 0;
  return {
      {wider + right, beside}, {wider - right, beside}, {higher + up, above}, {higher - up, above}};
}

/// Half-spaces that contain all that a view shows.
std::vector<Plane> borders(const ClpvView& view) {
  const glm::dvec3 forward = vector(view.forward);
  std::vector<Plane> planes = sides(view, view.half_width, view.half_height);
  planes.push_back({-forward, view.far_depth});
  if (view.orthographic == 0) planes.push_back({forward, -double{view.near_depth}});
  return planes;
}

/// Half-spaces outside the rasteriser's guard band, or beyond the near plane.
std::vector<Plane> beyond_guards(const ClpvView& view) {
  const double guard = 2.0 * double{CLPV_GUARD_PIXELS};
  std::vector<Plane> planes =
      sides(view, guard * view.half_width / view.width, guard * view.half_height / view.height);
  for (Plane& plane : planes) plane = {-plane.along, -plane.offset};
  if (view.orthographic == 0) planes.push_back({-vector(view.forward), view.near_depth});
  return planes;
}

/// Calls visit(i, true) if some point of box i may lie in the half-space, else visit(i, false).
template <typename Visit>
void for_each_reach(const ClpvView& view, const Boxes& boxes, const Plane& plane, Visit visit) {
  const float x = plane.along.x, y = plane.along.y, z = plane.along.z, offset = plane.offset,
              margin = kMargin * static_cast<float>(glm::length(plane.along));
  const float *cx = boxes.centre[0].data(), *cy = boxes.centre[1].data(),
              *cz = boxes.centre[2].data(), *hx = boxes.half[0].data(), *hy = boxes.half[1].data(),
              *hz = boxes.half[2].data();
  const float ex = view.eye[0], ey = view.eye[1], ez = view.eye[2];
  const float wide_x = std::abs(x) + margin, wide_y = std::abs(y) + margin,
              wide_z = std::abs(z) + margin;
  const std::size_t count = boxes.centre[0].size();
  for (std::size_t i = 0; i < count; ++i) {
    const float dx = cx[i] - ex, dy = cy[i] - ey, dz = cz[i] - ez;
    const float nearest =
        x * dx + y * dy + z * dz + margin * (std::abs(dx) + std::abs(dy) + std::abs(dz));
    visit(i, nearest + (wide_x * hx[i] + wide_y * hy[i] + wide_z * hz[i]) + offset >= 0);
  }
}

}  // namespace

ClpvView camera_view(const SceneCamera& camera, int width, int height) {
  ClpvView view = make_view(axes(glm::normalize(glm::dvec3(camera.forward)), glm::dvec3(camera.up)),
                            glm::dvec3(camera.eye), width, height);
  const double tangent = std::tan(0.5 * camera.vertical_fov);
  view.half_height = tangent;
  view.half_width = tangent * width / height;
  view.near_depth = camera.near_depth;
  view.far_depth = std::numeric_limits<float>::max();
  return view;
}

ClpvView directional_rsm_view(const ClpvLight& light, const ClpvGrid& cascade, const Bounds& bounds,
                              int size) {
  if (size < 2)
    throw Error(ExitCode::usage, "an RSM of {} texels along each side; allowed: 2 and more", size);
  const Axes frame = light_axes(glm::normalize(vector(light.direction)));
  const double half = 0.5 * (static_cast<double>(cascade.n) + 1) * cascade.cell;
  const glm::dvec3 centre =
      vector(cascade.origin) + 0.5 * static_cast<double>(cascade.n) * cascade.cell;
  double middle[2], half_extent[2];
  for (int axis = 0; axis < 2; ++axis) {
    const glm::dvec3 along = axis == 0 ? frame.right : frame.up;
    // Half the extent of the cube along this axis.
    const double reach = half * glm::dot(glm::abs(along), glm::dvec3(1));
    // One spare texel: snapping moves the window by up to one.
    const double texel = 2 * reach / (size - 1);
    const double first = std::floor((glm::dot(centre, along) - reach) / texel);
    middle[axis] = (first + 0.5 * size) * texel;
    half_extent[axis] = 0.5 * size * texel;
  }
  return orthographic_view(frame, middle[0], middle[1], half_extent[0], half_extent[1], bounds,
                           size);
}

ClpvView spot_view(const ClpvLight& light, int size, const Bounds& bounds) {
  if (too_wide_for_one_view(light)) {
    throw Error(ExitCode::run_time,
                "a spot light with an outer half-angle of {:.4f} rad in one view; allowed: {:.4f}",
                outer_angle(light), kWidestSpotView);
  }
  const double tangent = std::max(std::tan(outer_angle(light)), 1e-3);
  return perspective_light_view(light_axes(glm::normalize(vector(light.direction))), light, tangent,
                                size, bounds);
}

std::vector<ClpvView> point_views(const ClpvLight& light, int size, const Bounds& bounds) {
  std::vector<ClpvView> views;
  for (int side = 0; side < 6; ++side) {
    glm::dvec3 forward(0);
    forward[side / 2] = side % 2 == 0 ? 1 : -1;
    views.push_back(perspective_light_view(light_axes(forward), light, 1, size, bounds));
  }
  return views;
}

std::vector<BoxPlace> places_of(const ClpvView& view, const Boxes& boxes) {
  const std::size_t count = boxes.centre[0].size();
  std::vector<std::uint8_t> visible(count, 1), clipped(count, 0);
  for (const Plane& plane : borders(view))
    for_each_reach(view, boxes, plane, [&](std::size_t i, bool reaches) { visible[i] &= reaches; });
  for (const Plane& plane : beyond_guards(view))
    for_each_reach(view, boxes, plane, [&](std::size_t i, bool reaches) { clipped[i] |= reaches; });
  std::vector<BoxPlace> places(count);
  for (std::size_t i = 0; i < count; ++i)
    places[i] = visible[i] == 0   ? BoxPlace::outside
                : clipped[i] == 0 ? BoxPlace::inside
                                  : BoxPlace::clipped;
  return places;
}

ClpvViewCluster place_cluster(const ClpvView& view, const Boxes& boxes, unsigned number) {
  const auto &centre = boxes.centre, &half = boxes.half;
  const float x = centre[0][number] - view.eye[0], y = centre[1][number] - view.eye[1],
              z = centre[2][number] - view.eye[2], wide = half[0][number], high = half[1][number],
              deep = half[2][number];
  const float margin = kMargin * (std::abs(x) + std::abs(y) + std::abs(z) + wide + high + deep);
  /// Smallest and largest distance from the eye along an axis.
  const auto span = [&](const float* axis) {
    const float middle = axis[0] * x + axis[1] * y + axis[2] * z,
                reach = std::abs(axis[0]) * wide + std::abs(axis[1]) * high +
                        std::abs(axis[2]) * deep + margin;
    return std::pair(middle - reach, middle + reach);
  };
  /// Tile of the pixel beside a distance from the left or top border.
  const auto tile = [](float across, float half_extent, int pixels, int beside) {
    const float pixel = (across / half_extent + 1) * 0.5f * pixels + beside;
    return static_cast<unsigned>(std::clamp(pixel, 0.0f, pixels - 1.0f)) / CLPV_TILE;
  };
  const int width = view.width, height = view.height;
  const auto [left, right] = span(view.right);
  const auto [bottom, top] = span(view.up);
  return {
      number, 0,
      tile(left, view.half_width, width, -1) + (tile(-top, view.half_height, height, -1) << 16),
      tile(right, view.half_width, width, 1) + (tile(-bottom, view.half_height, height, 1) << 16),
      span(view.forward).first};
}

LightBounds light_bounds(const std::vector<Vertex>& vertices, const Bounds& all,
                         const ClpvGrid& coarsest) {
  const double half = 0.5 * static_cast<double>(coarsest.n) * coarsest.cell;
  const glm::dvec3 middle = vector(coarsest.origin) + half;
  /// Smallest k for which the cube about the middle with half edge 2^k * half contains the vertex;
  /// 0 in the cascade.
  const auto cube_of = [&](const Vertex& v) {
    const glm::dvec3 off = glm::abs(vector(v.position) - middle) / half;
    const double farthest = std::max({off.x, off.y, off.z});
    return farthest > 1 ? std::min(std::ilogb(farthest) + 1, kMaxCubes - 1) : 0;
  };
  std::array<bool, kMaxCubes> used{};
  for (const Vertex& v : vertices) used[cube_of(v)] = true;
  int last = 0;  // cube before the first gap
  for (int k = 1; k < kMaxCubes && k <= last + kGapCubes + 1; ++k) {
    if (used[k]) last = k;
  }
  if (std::find(used.begin() + last + 1, used.end(), true) == used.end()) return {all, all};
  const double outer = half + double{coarsest.cell};  // virtual point lights move by half a cell
  const Bounds cube{glm::vec3(middle - outer), glm::vec3(middle + outer)};
  Bounds near{cube.upper, cube.lower};  // nothing yet
  for (const Vertex& v : vertices) {
    if (cube_of(v) > last) continue;
    const glm::vec3 p(vector(v.position));
    near = {glm::min(near.lower, p), glm::max(near.upper, p)};
  }
  if (glm::any(glm::lessThan(near.upper, near.lower))) near = cube;
  return {near, {glm::min(near.lower, cube.lower), glm::max(near.upper, cube.upper)}};
}

bool rsm_follows_cascade(const ClpvLight& light) {
  return kind_of(light) == LightKind::directional;
}

std::vector<ClpvView> rsm_views(const ClpvLight& light, const ClpvGrid& cascade,
                                const Bounds& bounds, int size) {
  if (rsm_follows_cascade(light)) return {directional_rsm_view(light, cascade, bounds, size)};
  return shadow_views(light, bounds, size);
}

std::vector<ClpvView> shadow_views(const ClpvLight& light, const Bounds& bounds, int size) {
  switch (kind_of(light)) {
    case LightKind::directional:
      return {directional_shadow_view(light, bounds, size)};
    case LightKind::spot:
      if (!too_wide_for_one_view(light)) return {spot_view(light, size, bounds)};
      break;
    case LightKind::point:
      break;
  }
  return point_views(light, size, bounds);
}

}  // namespace clpv
