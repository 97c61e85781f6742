// SPDX-License-Identifier: MIT
// Builds Embree's scene, with filter functions for alpha masks and back faces.
#include "pathtracer/ray_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "reference/view.hpp"
#include "support/error.hpp"

#if CLPV_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace clpv::pathtracer {
namespace {

// Common interface to Embree 3 and 4 for queries with a filter function per ray.
#if CLPV_EMBREE_MAJOR >= 4

using RtcContext = RTCRayQueryContext;
inline constexpr RTCSceneFlags kRtcQueryFilters = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;

/// Finds the nearest hit. `filter` runs besides the geometries' own filters; null: only those.
inline void rtc_intersect(RTCScene scene, RtcContext& context, RTCFilterFunctionN filter,
                          RTCRayHit& query) {
  rtcInitRayQueryContext(&context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  arguments.filter = filter;
  if (filter != nullptr)
    arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;  // for all geometries
  rtcIntersect1(scene, &query, &arguments);
}

/// Sets ray.tfar to -infinity if anything blocks the ray.
inline void rtc_occluded(RTCScene scene, RTCRay& ray) {
  rtcOccluded1(scene, &ray);
}

#else

using RtcContext = RTCIntersectContext;
inline constexpr RTCSceneFlags kRtcQueryFilters = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

inline void rtc_intersect(RTCScene scene, RtcContext& context, RTCFilterFunctionN filter,
                          RTCRayHit& query) {
  rtcInitIntersectContext(&context);
  context.filter = filter;
  rtcIntersect1(scene, &context, &query);
}

inline void rtc_occluded(RTCScene scene, RTCRay& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
}

#endif

// Embree's geometries. Only masked triangles have the filter for alpha masks.
constexpr unsigned kOpaque = 0, kMasked = 1;

struct RtcRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using RtcDevice = std::unique_ptr<std::remove_pointer_t<RTCDevice>, RtcRelease>;
using RtcScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, RtcRelease>;

void check(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw Error(ExitCode::run_time, "Embree: out of memory");
  if (error != RTC_ERROR_NONE)
    throw Error(ExitCode::run_time, "Embree: error {}", static_cast<int>(error));
}

}  // namespace

struct RayScene::Impl {
  const SceneData* scene = nullptr;
  std::optional<reference::Materials> materials;
  std::array<std::vector<std::uint32_t>, 2> triangles;  // indices in scene->triangles, by geometry
  RtcDevice device;
  RtcScene rtc;

  std::uint32_t triangle(const RTCHit& hit) const { return triangles[hit.geomID][hit.primID]; }
  void attach(unsigned id);
};

namespace {

/// Query context for the filter functions.
struct QueryContext {
  RtcContext base;
  const RayScene::Impl* impl;
};

/// Rejects hits in holes of masked materials.
void filter_mask(const RTCFilterFunctionNArguments* args) {
  const auto& impl = *static_cast<const RayScene::Impl*>(args->geometryUserPtr);
  const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
  if (impl.materials->hole({impl.triangle(*hit), {hit->u, hit->v}})) args->valid[0] = 0;
}

/// Rejects hits on back faces of single-sided triangles. Embree's normal is cross(v1 - v0, v2 -
/// v0), which points to glTF's front: the side with counter-clockwise vertices.
void filter_back_faces(const RTCFilterFunctionNArguments* args) {
  const auto& impl = *reinterpret_cast<const QueryContext*>(args->context)->impl;
  const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
  const auto* ray = reinterpret_cast<const RTCRay*>(args->ray);
  const Triangle& triangle = impl.scene->triangles[impl.triangle(*hit)];
  if (impl.scene->materials[triangle.material].flags & CLPV_MATERIAL_DOUBLE_SIDED) return;
  if (hit->Ng_x * ray->dir_x + hit->Ng_y * ray->dir_y + hit->Ng_z * ray->dir_z >= 0)
    args->valid[0] = 0;
}

RTCRay make_ray(const glm::vec3& origin, const glm::vec3& direction, float nearest,
                float furthest) {
  RTCRay ray{};
  ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
  ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
  ray.tnear = nearest, ray.tfar = furthest;
  ray.mask = ~0u;
  return ray;
}

}  // namespace

void RayScene::Impl::attach(unsigned id) {
  const std::vector<std::uint32_t>& indices = triangles[id];
  if (indices.empty()) return;
  const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             scene->vertices.data(), 0, sizeof(Vertex), scene->vertices.size());
  auto* out = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), indices.size()));
  check(device.get());
  for (const std::uint32_t i : indices) out = std::copy_n(scene->triangles[i].vertex, 3, out);
  rtcSetGeometryUserData(geometry, this);
  if (id == kMasked) {
    rtcSetGeometryIntersectFilterFunction(geometry, filter_mask);
    rtcSetGeometryOccludedFilterFunction(geometry, filter_mask);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(rtc.get(), geometry, id);
  rtcReleaseGeometry(geometry);
  check(device.get());
}

reference::Footprint footprint(const ClpvView& view, unsigned px, unsigned py, const Hit& hit) {
  const glm::dvec3 normal(hit.geometric),
      here = reference::surface_position(view, px, py, hit.distance);
  const glm::dvec3 ray =
      reference::surface_position(view, px, py, 1) - reference::surface_position(view, px, py, 0);
  const auto step = [&](double x, double y) {
    // At the same depth.
    const glm::dvec3 offset = reference::surface_position(view, x, y, hit.distance) - here;
    return offset -
           ray * glm::dot(normal, offset) / glm::dot(normal, ray);  // onto the triangle's plane
  };
  return {step(px + 1.0, py), step(px, py + 1.0)};
}

void require_rays(ExitCode) {}

RayScene::RayScene(const SceneData& scene) : impl_(std::make_unique<Impl>()) {
  if (scene.triangles.empty()) {
    throw Error(ExitCode::bad_input, "{}: no surface", scene.path);
  }
  impl_->scene = &scene;
  impl_->materials.emplace(scene);
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    const bool masked = scene.materials[scene.triangles[i].material].flags & CLPV_MATERIAL_MASKED;
    impl_->triangles[masked ? kMasked : kOpaque].push_back(i);
  }
  // One thread builds, so that the tree, and the choice between coincident triangles, do not depend
  // on scheduling.
  impl_->device.reset(rtcNewDevice("threads=1,set_affinity=0"));
  if (!impl_->device) check(nullptr);
  impl_->rtc.reset(rtcNewScene(impl_->device.get()));
  rtcSetSceneFlags(impl_->rtc.get(), RTC_SCENE_FLAG_ROBUST | kRtcQueryFilters);
  rtcSetSceneBuildQuality(impl_->rtc.get(), RTC_BUILD_QUALITY_HIGH);
  impl_->attach(kOpaque);
  impl_->attach(kMasked);
  rtcCommitScene(impl_->rtc.get());
  check(impl_->device.get());
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

const reference::Materials& RayScene::materials() const {
  return *impl_->materials;
}

std::optional<Hit> RayScene::intersect(const glm::vec3& origin, const glm::vec3& direction,
                                       float nearest, float furthest, Faces faces) const {
  QueryContext context{{}, impl_.get()};
  RTCRayHit query{};
  query.ray = make_ray(origin, direction, nearest, furthest);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtc_intersect(impl_->rtc.get(), context.base,
                faces == Faces::culled ? filter_back_faces : nullptr, query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

  const SceneData& scene = *impl_->scene;
  Hit hit;
  hit.point = {impl_->triangle(query.hit), {query.hit.u, query.hit.v}};
  const Triangle& triangle = scene.triangles[hit.point.triangle];
  hit.distance = query.ray.tfar;
  hit.position = reference::interpolate(scene, triangle, hit.point.weights, reference::position);
  hit.geometric = glm::normalize(glm::vec3(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z));
  if (glm::dot(hit.geometric, direction) > 0) hit.geometric = -hit.geometric;
  hit.normal = reference::interpolate(scene, triangle, hit.point.weights, reference::normal);
  const float length = glm::length(hit.normal);
  // 0 if opposite normals cancel out.
  hit.normal = length > 0 ? hit.normal / length : hit.geometric;
  if (glm::dot(hit.normal, hit.geometric) < 0) hit.normal = -hit.normal;
  return hit;
}

bool RayScene::occluded(const glm::vec3& origin, const glm::vec3& direction, float furthest) const {
  RTCRay ray = make_ray(origin, direction, 0, furthest);
  rtc_occluded(impl_->rtc.get(), ray);
  return ray.tfar < 0;
}

namespace {

/// Triangles whose boxes a sphere meets.
struct NearTriangles {
  const RayScene::Impl* impl;
  std::vector<std::uint32_t> found;
};

bool add_near(RTCPointQueryFunctionArguments* args) {
  auto& near = *static_cast<NearTriangles*>(args->userPtr);
  near.found.push_back(near.impl->triangles[args->geomID][args->primID]);
  return false;  // the radius stays
}

/// Unit normal of a triangle's front, if the point lies less than `reach` from its plane and not
/// farther than that outside an edge; `height` receives the distance, negative behind.
std::optional<glm::dvec3> front_below(const std::array<glm::dvec3, 3>& corners,
                                      const glm::dvec3& point, double reach, double& height) {
  const glm::dvec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double area = glm::length(across);
  if (!(area > 0)) return std::nullopt;
  const glm::dvec3 front = across / area;
  height = glm::dot(point - corners[0], front);
  if (!(std::abs(height) < reach)) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 edge = corners[(i + 1) % 3] - corners[i];
    if (glm::dot(glm::cross(edge, point - corners[i]), front) < -reach * glm::length(edge))
      return std::nullopt;
  }
  return front;
}

}  // namespace

glm::dvec3 RayScene::way_off_surfaces(const glm::dvec3& point, const glm::dvec3& normal,
                                      double distance) const {
  constexpr double kTangential = -1e-3;
  constexpr int kPasses = 4;  // where walls meet at sharp angles
  NearTriangles near{impl_.get(), {}};
  RTCPointQuery query{};
  query.x = static_cast<float>(point.x), query.y = static_cast<float>(point.y);
  query.z = static_cast<float>(point.z), query.radius = static_cast<float>(distance);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(impl_->rtc.get(), &query, &context, add_near, &near);
  std::ranges::sort(near.found);
  glm::dvec3 way(0);
  for (int pass = 0; pass < kPasses; ++pass) {
    for (const std::uint32_t triangle : near.found) {
      double height = 0;
      const auto front = front_below(corners_of(*impl_->scene, impl_->scene->triangles[triangle]),
                                     point, distance / 2, height);
      if (!front) continue;
      const double side = glm::dot(*front, normal) < kTangential ? -1 : 1;
      const double missing = distance - side * (height + glm::dot(way, *front));
      if (missing > 0) way += missing * side * *front;
    }
  }
  return way;
}

/// Interpolation, and a later ray's test of the same triangle, err by a few roundings of the
/// position and of the corners as seen from it. The offset along the normal n is |n| . (bound of
/// each axis), as in pbrt-v4, 6.8.6 (Pharr, Jakob, Humphreys 2023). That is 0 on a plane such as y
/// = 0, where the test's own roundings along the other axes remain.
glm::vec3 RayScene::offset_origin(const Hit& hit) const {
  constexpr double kRoundings = 32, kTestRoundings = 8;
  constexpr double kRounding = 0.5 * double{std::numeric_limits<float>::epsilon()};
  const glm::dvec3 position(hit.position), normal(hit.geometric);
  glm::dvec3 reach(0);
  for (const glm::dvec3& corner :
       corners_of(*impl_->scene, impl_->scene->triangles[hit.point.triangle]))
    reach = glm::max(reach, glm::abs(corner - position));
  const glm::dvec3 numbers = glm::abs(position) + reach;
  const double largest = std::max({numbers.x, numbers.y, numbers.z});
  const glm::dvec3 bound = kRounding * (kRoundings * numbers + kTestRoundings * largest);
  const glm::dvec3 exact = position + glm::dot(glm::abs(normal), bound) * normal;
  glm::vec3 origin(exact);
  for (int axis = 0; axis < 3; ++axis) {  // rounded away from the surface
    const float away = std::copysign(std::numeric_limits<float>::infinity(), hit.geometric[axis]);
    if ((exact[axis] - double{origin[axis]}) * normal[axis] > 0)
      origin[axis] = std::nextafter(origin[axis], away);
  }
  return origin;
}

}  // namespace clpv::pathtracer
