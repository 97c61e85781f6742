// A scene that rays can be shot through: Embree in its robust mode, with alpha masks and the colours of what
// is hit.
#include "reference/ray_scene.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "reference/texture_lookup.hpp"
#include "support/error.hpp"

namespace clpv::reference {
namespace {

constexpr unsigned kOpaque = 0,
                   kMasked = 1;  // Embree's geometries: masked triangles alone pay for the filter

template <std::size_t size>
bool finite(const float (&values)[size]) {
  return std::all_of(std::begin(values), std::end(values), [](float v) { return std::isfinite(v); });
}

void check_vertices(const Scene& scene) {
  for (std::size_t i = 0; i < scene.vertices.size(); ++i) {
    const Vertex& v = scene.vertices[i];
    if (!finite(v.position) || !finite(v.normal) || !finite(v.colour)) {
      throw Error(ExitCode::bad_input, "{}: vertex {}: a position, normal or colour that is not finite",
                  scene.path, i);
    }
  }
}

void check_triangles(const Scene& scene) {
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    const Triangle& t = scene.triangles[i];
    const std::uint32_t vertex = std::max({t.vertex[0], t.vertex[1], t.vertex[2]});
    if (vertex >= scene.vertices.size() || t.material >= scene.materials.size()) {
      throw Error(ExitCode::bad_input, "{}: triangle {}: vertex {} of {}, material {} of {}", scene.path, i,
                  vertex, scene.vertices.size(), t.material, scene.materials.size());
    }
  }
}

void check_materials(const Scene& scene) {
  const auto known = [&](std::uint32_t t) { return t == CLPV_NO_TEXTURE || t < scene.textures.size(); };
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    if (!finite(m.base_colour) || !finite(m.emissive) || !std::isfinite(m.alpha_cutoff)) {
      throw Error(ExitCode::bad_input, "{}: material {}: a colour or alpha cutoff that is not finite",
                  scene.path, i);
    }
    if (!known(m.texture) || !known(m.emissive_texture)) {
      throw Error(ExitCode::bad_input, "{}: material {}: texture {} and {} of {}", scene.path, i, m.texture,
                  m.emissive_texture, scene.textures.size());
    }
  }
  for (const Texture& t : scene.textures) {
    if (t.width == 0 || t.height == 0 || t.rgba.size() != 4 * static_cast<std::size_t>(t.width) * t.height) {
      throw Error(ExitCode::bad_input, "{}: texture {}: {} bytes for {}x{} texels of 4", scene.path, t.name,
                  t.rgba.size(), t.width, t.height);
    }
  }
}

/// A value of the three vertices at Embree's barycentric (u, v).
template <typename Get>
auto interpolate(const Scene& scene, const Triangle& triangle, float u, float v, Get get) {
  return (1 - u - v) * get(scene.vertices[triangle.vertex[0]]) + u * get(scene.vertices[triangle.vertex[1]]) +
         v * get(scene.vertices[triangle.vertex[2]]);
}

glm::vec3 to_vec3(const float (&v)[3]) {
  return {v[0], v[1], v[2]};
}
glm::vec3 position(const Vertex& v) {
  return to_vec3(v.position);
}
glm::vec3 normal(const Vertex& v) {
  return to_vec3(v.normal);
}
glm::vec2 coordinates(const Vertex& v) {
  return {v.uv[0], v.uv[1]};
}
glm::vec4 colour(const Vertex& v) {
  return {v.colour[0], v.colour[1], v.colour[2], v.colour[3]};
}

/// Base colour and alpha of a triangle at (u, v).
glm::vec4 base_colour(const Scene& scene, const Triangle& triangle, float u, float v) {
  const Material& material = scene.materials[triangle.material];
  const auto& factor = material.base_colour;
  const glm::vec4 untextured =
      glm::vec4(factor[0], factor[1], factor[2], factor[3]) * interpolate(scene, triangle, u, v, colour);
  if (material.texture == CLPV_NO_TEXTURE) return untextured;
  return untextured *
         look_up(scene.textures[material.texture], interpolate(scene, triangle, u, v, coordinates));
}

glm::vec3 emitted(const Scene& scene, const Triangle& triangle, float u, float v) {
  const Material& material = scene.materials[triangle.material];
  const glm::vec3 radiance = to_vec3(material.emissive);
  if (material.emissive_texture == CLPV_NO_TEXTURE || radiance == glm::vec3(0)) return radiance;
  const glm::vec2 uv = interpolate(scene, triangle, u, v, coordinates);
  return radiance * glm::vec3(look_up(scene.textures[material.emissive_texture], uv));
}

struct RtcRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using RtcDevice = std::unique_ptr<std::remove_pointer_t<RTCDevice>, RtcRelease>;
using RtcScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, RtcRelease>;

void check(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw Error(ExitCode::run_time, "Embree: out of memory");
  if (error != RTC_ERROR_NONE) throw Error(ExitCode::run_time, "Embree: error {}", static_cast<int>(error));
}

}  // namespace

struct RayScene::Impl {
  const Scene* scene = nullptr;
  std::array<std::vector<std::uint32_t>, 2>
      triangles;     // Embree's (geometry, primitive) -> index in scene->triangles
  float extent = 0;  // largest coordinate [m]
  RtcDevice device;
  RtcScene rtc;

  const Triangle& triangle(unsigned geometry, unsigned primitive) const {
    return scene->triangles[triangles[geometry][primitive]];
  }
  void attach(unsigned id);
};

namespace {

/// What a ray carries to the filters.
struct Context {
  RTCIntersectContext base;
  const RayScene::Impl* impl;
};

/// Lets rays pass through the holes of masked materials.
void filter_mask(const RTCFilterFunctionNArguments* args) {
  const auto& impl = *static_cast<const RayScene::Impl*>(args->geometryUserPtr);
  const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
  const Triangle& triangle = impl.triangle(hit->geomID, hit->primID);
  const float alpha = base_colour(*impl.scene, triangle, hit->u, hit->v).a;
  if (alpha < impl.scene->materials[triangle.material].alpha_cutoff) args->valid[0] = 0;
}

/// Lets rays pass through single-sided triangles from behind. Embree's normal is cross(v1 - v0, v2 - v0): it
/// points to where the triangle is seen counter-clockwise, which is glTF's front.
void filter_back_faces(const RTCFilterFunctionNArguments* args) {
  const auto& impl = *reinterpret_cast<const Context*>(args->context)->impl;
  const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
  const auto* ray = reinterpret_cast<const RTCRay*>(args->ray);
  const Triangle& triangle = impl.triangle(hit->geomID, hit->primID);
  if (impl.scene->materials[triangle.material].flags & CLPV_MATERIAL_DOUBLE_SIDED) return;
  if (hit->Ng_x * ray->dir_x + hit->Ng_y * ray->dir_y + hit->Ng_z * ray->dir_z >= 0) args->valid[0] = 0;
}

RTCRay make_ray(const glm::vec3& origin, const glm::vec3& direction, float nearest, float furthest) {
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
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, scene->vertices.data(),
                             0, sizeof(Vertex), scene->vertices.size());
  auto* out = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), indices.size()));
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

RayScene::RayScene(const Scene& scene) : impl_(std::make_unique<Impl>()) {
  if (scene.triangles.empty()) {
    throw Error(ExitCode::bad_input, "{}: no surface: there is nothing that light could reach", scene.path);
  }
  check_vertices(scene);
  check_triangles(scene);
  check_materials(scene);
  impl_->scene = &scene;
  for (const Vertex& v : scene.vertices) {
    impl_->extent =
        std::max({impl_->extent, std::abs(v.position[0]), std::abs(v.position[1]), std::abs(v.position[2])});
  }
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    const bool masked = scene.materials[scene.triangles[i].material].flags & CLPV_MATERIAL_MASKED;
    impl_->triangles[masked ? kMasked : kOpaque].push_back(i);
  }
  // One thread builds, so that the tree (and which of two coincident triangles is hit) never depends on
  // scheduling.
  impl_->device.reset(rtcNewDevice("threads=1,set_affinity=0"));
  if (!impl_->device) check(nullptr);
  impl_->rtc.reset(rtcNewScene(impl_->device.get()));
  rtcSetSceneFlags(impl_->rtc.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  rtcSetSceneBuildQuality(impl_->rtc.get(), RTC_BUILD_QUALITY_HIGH);
  impl_->attach(kOpaque);
  impl_->attach(kMasked);
  rtcCommitScene(impl_->rtc.get());
  check(impl_->device.get());
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

const Scene& RayScene::scene() const {
  return *impl_->scene;
}

std::optional<Hit> RayScene::intersect(const glm::vec3& origin, const glm::vec3& direction, float nearest,
                                       float furthest, Faces faces) const {
  Context context{{}, impl_.get()};
  rtcInitIntersectContext(&context.base);
  if (faces == Faces::as_seen) context.base.filter = filter_back_faces;
  RTCRayHit query{};
  query.ray = make_ray(origin, direction, nearest, furthest);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->rtc.get(), &context.base, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

  const Scene& scene = *impl_->scene;
  const float u = query.hit.u, v = query.hit.v;
  Hit hit;
  hit.triangle = impl_->triangles[query.hit.geomID][query.hit.primID];
  hit.weights = {u, v};
  const Triangle& triangle = scene.triangles[hit.triangle];
  hit.distance = query.ray.tfar;
  hit.position = interpolate(scene, triangle, u, v, position);
  hit.geometric = glm::normalize(glm::vec3(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z));
  if (glm::dot(hit.geometric, direction) > 0) hit.geometric = -hit.geometric;
  hit.normal = interpolate(scene, triangle, u, v, normal);
  const float length = glm::length(hit.normal);
  hit.normal = length > 0 ? hit.normal / length : hit.geometric;  // vertices that disagree may cancel out
  if (glm::dot(hit.normal, hit.geometric) < 0) hit.normal = -hit.normal;
  return hit;
}

glm::vec3 RayScene::albedo(const Hit& hit) const {
  const Scene& scene = *impl_->scene;
  return glm::vec3(base_colour(scene, scene.triangles[hit.triangle], hit.weights.x, hit.weights.y));
}

glm::vec3 RayScene::emissive(const Hit& hit) const {
  const Scene& scene = *impl_->scene;
  return emitted(scene, scene.triangles[hit.triangle], hit.weights.x, hit.weights.y);
}

bool RayScene::occluded(const glm::vec3& origin, const glm::vec3& direction, float furthest) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray = make_ray(origin, direction, 0, furthest);
  rtcOccluded1(impl_->rtc.get(), &context, &ray);
  return ray.tfar < 0;
}

glm::vec3 RayScene::leave(const Hit& hit) const {
  // Embree's robust test is exact to some ulp of the triangle's coordinates; these are tens of ulp.
  constexpr float kOfPosition = 1e-5f, kOfExtent = 1e-6f;
  const glm::vec3 size = glm::abs(hit.position);
  const float offset = kOfPosition * std::max({size.x, size.y, size.z}) + kOfExtent * impl_->extent;
  return hit.position + offset * hit.geometric;
}

}  // namespace clpv::reference
