// SPDX-License-Identifier: MIT
#include "verify/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

#include "basis/matrix.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/raster/view.hpp"
#include "pipeline/voxels/voxel_field.hpp"
#include "verify/check.hpp"

namespace clpv::verify {

namespace {

constexpr unsigned kInputWidth = 45, kInputHeight = 31;  // no multiples of a work-group
constexpr float kFarthest = 12;                          // [m]
constexpr double kHeightError = 1e-6;  // height of a rotated centre in float32; measured 3e-7

void add_materials(SceneData& scene, std::mt19937& random) {
  Texture texture{.width = 5, .height = 4, .wrap_u = CLPV_WRAP_MIRROR, .rgba = {}, .name = "holes"};
  for (int i = 0; i < 5 * 4 * 4; ++i)
    texture.rgba.push_back(static_cast<std::uint8_t>(random() % 256));
  scene.textures.push_back(texture);
  for (const unsigned flags : {0u, CLPV_MATERIAL_MASKED}) {
    ClpvMaterial material{{0.9f, 0.6f, 0.3f, 0.9f}, {}, 0.4f, 0, CLPV_NO_TEXTURE, flags, 0};
    scene.materials.push_back(material);
  }
}

constexpr int kMapSize = 16;  // texels along each side of a shadow map

reference::MappedLight mapped(ClpvLight light, const ClpvMedium& medium, float depth) {
  light.medium = medium;
  return mapped_light(light, kWideBounds, kMapSize, kMapSize, [&] { return depth; });
}

}  // namespace

SurfaceImage random_surfaces(std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(0, 1);
  SurfaceImage image;
  ClpvView& view = image.view;
  view.eye[0] = 0.3f, view.eye[1] = -0.2f, view.eye[2] = 0.6f;
  view.right[2] = view.up[1] = view.forward[0] = 1;
  view.half_width = 1.2f, view.half_height = 0.8f;
  view.near_depth = 0.01f, view.far_depth = 100;
  view.width = kInputWidth, view.height = kInputHeight;
  for (unsigned pixel = 0; pixel < kInputWidth * kInputHeight; ++pixel) {
    const float depth = 1.1f * uniform(random) - 0.1f;
    const glm::vec3 n(uniform(random) - 0.5f, uniform(random) - 0.5f, uniform(random) - 0.4995f);
    image.depth.push_back(depth > 0 ? kFarthest * depth * depth : 0.0f);
    // Every third surface's triangle has another normal, tilted by up to 45 degrees.
    const glm::vec3 tilt(uniform(random) - 0.5f, uniform(random) - 0.5f, uniform(random) - 0.5f);
    const glm::dvec3 shading(glm::normalize(n));
    image.normal.push_back(stored_normal(
        shading, pixel % 3 == 0 ? glm::normalize(shading + 0.8 * glm::dvec3(tilt)) : shading));
    image.colour.emplace_back(uniform(random), uniform(random), uniform(random), 1.0f);
    image.emissive.emplace_back(uniform(random), uniform(random), uniform(random), 0.0f);
  }
  return image;
}

bool rounding_decides(const Basis& basis, const LobeOptions& options, const glm::dvec3& direction) {
  if (basis.centres().empty()) return false;
  const ZonalTable table(options.table_size, [](double) { return 0.0; });
  const double near = kHeightError * options.table_size / 2;
  const auto unsure = [&](const glm::dvec3& a, const glm::dvec3& b) {
    return table.to_step(glm::dot(a, b)) < near;
  };
  const glm::dmat3 there = rotation_to(direction), back = rotation_to(-direction);
  for (const glm::dvec3& a : basis.centres()) {
    if (options.table_functions && (unsure(a, direction) || unsure(a, -direction))) return true;
    if (options.kind != LobeKind::rotate) continue;
    for (const glm::dvec3& b : basis.centres()) {
      if (unsure(a, there * b) || unsure(a, back * b)) return true;
    }
  }
  return false;
}

Deviation compare_pixels(Session& session, const Buffer& pixels, std::span<const double> expected,
                         unsigned width, double allowed, std::size_t every,
                         const std::vector<bool>& uncertain) {
  const std::size_t count = pixels.bytes() / sizeof(cl_float4);
  const auto place = [&](std::size_t i) { return 4 * (i / 4 * every) + i % 4; };
  std::vector<double> compared(expected.begin(), expected.end());
  for (std::size_t i = 0; i < compared.size() && !uncertain.empty(); ++i)
    if (uncertain[i / 4]) compared[i] = NAN;
  Ranges ranges(4 * count);
  const Ranges about = ranges_about(compared, allowed);
  for (std::size_t i = 0; i < about.size(); ++i) ranges[place(i)] = about[i];
  expect(session, pixels, "float", ranges);

  const auto device = session.read<float>(pixels, 4 * count);
  const auto found = [&](std::size_t i) { return double{device[place(i)]}; };
  const auto wanted = [&](std::size_t i) {
    return !uncertain.empty() && uncertain[i / 4] ? found(i) : expected[i];
  };
  const WorstError worst = worst_difference(expected.size(), found, wanted);
  if (worst.value == 0) return {0, allowed};
  const std::size_t pixel = worst.at / 4 * every;
  return {worst.value, allowed,
          fmt::format("pixel {},{} channel {}: {:.7g}, expected {:.7g}", pixel % width,
                      pixel / width, worst.at % 4, found(worst.at), wanted(worst.at))};
}

void append_pixel(std::vector<double>& values, const glm::dvec3& colour, double alpha) {
  values.insert(values.end(), {colour.x, colour.y, colour.z, alpha});
}

SceneData triangle_soup() {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto direction = [&] {
    return glm::vec3(uniform(random), uniform(random), uniform(random));
  };
  SceneData scene;
  add_materials(scene, random);
  const glm::vec3 middle(-0.25f, 2.75f, 3.25f);
  for (int i = 0; i < 150; ++i) {
    const float size = std::exp(6 * uniform(random) - 3);  // 0.0025 to 20 m
    const glm::vec3 at = middle + (i % 10 == 9 ? 6.0f : 2.5f) * direction();
    Triangle triangle{{}, static_cast<unsigned>(i % 3 == 0)};
    for (unsigned& vertex : triangle.vertex) {
      glm::vec3 p = at + size * direction();
      if (i % 7 == 3) p[i % 3] = at[i % 3];
      if (i == 20) p = at;
      vertex = scene.vertices.size();
      scene.vertices.push_back({{p.x, p.y, p.z},
                                {0, 0, 1},
                                {2 * uniform(random), 2 * uniform(random)},
                                {0.8f, uniform(random) > 0 ? 0.6f : 1.0f, 1, 0.95f}});
    }
    scene.triangles.push_back(triangle);
  }
  return scene;
}

std::shared_ptr<reference::Volume> random_light(const Basis& basis, int n, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-0.3f, 1);
  auto volume = std::make_shared<reference::Volume>(n, basis.size());
  for (double& value : volume->values) value = uniform(random) > 0.5f ? uniform(random) : 0;
  return volume;
}

std::shared_ptr<reference::Volume> random_blockers(int numbers, int n, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-0.5f, 1);
  auto volume = std::make_shared<reference::Volume>(n + 1, numbers, 1);
  for (double& value : volume->values) value = std::max(0.0f, uniform(random));
  return volume;
}

Volume on_device(Session& session, const reference::Volume& from, const VolumeFormat& format) {
  Volume volume(session, {from.n, from.coefficients, from.channels}, "volume", format);
  volume.write(session, {from.values.begin(), from.values.end()});
  return volume;
}

std::vector<std::uint8_t> random_occlusion(int cascades, int grid, std::mt19937& random) {
  std::vector<std::uint8_t> occluded(cascades * visibility_bytes(grid));
  for (std::uint8_t& bits : occluded) bits = random() % 256;
  return occluded;
}

/// The same light with a white furnace in channel 3 that is 0.3 to 1 in the mean.
SharedVolume with_furnace(const reference::Volume& light, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(0.3f, 1);
  auto volume = std::make_shared<reference::Volume>(light.n, light.coefficients, 4);
  std::ranges::copy(light.values, volume->values.begin());
  reference::for_each_cell(light.n, [&](const glm::ivec3& p) {
    for (int i = 0; i < light.coefficients; ++i)
      volume->at(3, i, p.x, p.y, p.z) =
          i == 0 ? 3.5f * uniform(random) : 0.4f * (uniform(random) - 0.65f);
  });
  return volume;
}

CascadeLight random_cascades(const Basis& basis, int count, double edge, int grid, bool furnace,
                             std::vector<std::uint8_t> occluded, std::mt19937& random) {
  CascadeLight result{
      cascade_grids({0.1f, 0.2f, 0.3f}, count, edge, grid), {}, std::move(occluded)};
  for (int c = 0; c < count; ++c) {
    result.light.push_back(random_light(basis, grid, random));
    if (furnace) result.light.back() = with_furnace(*result.light.back(), random);
  }
  return result;
}

CascadesOnDevice::CascadesOnDevice(Session& session, const CascadeLight& from,
                                   const VolumeFormat& format)
    : grids(from.grids) {
  for (const SharedVolume& light : from.light) stored.push_back(on_device(session, *light, format));
  const bool occludes = !from.occluded.empty();
  if (occludes) occluded = session.upload(from.occluded, "occluded cells");
  for (std::size_t c = 0; c < from.grids.size(); ++c) {
    const std::size_t first = c * visibility_bytes(static_cast<int>(from.grids[c].n));
    cascades.push_back(
        {from.grids[c], from.light[c].get(), occludes ? from.occluded.data() + first : nullptr});
  }
}

GatheredLight CascadesOnDevice::gathered() const {
  GatheredLight light{grids, {}};
  for (const Volume& volume : stored) light.accumulated.push_back(&volume);
  light.occluded = occluded;
  return light;
}

const ClpvLight kSun{
    {}, CLPV_LIGHT_DIRECTIONAL, {2 / 7.0f, -6 / 7.0f, 3 / 7.0f}, 0, {3, 2, 1}, 0, 0, 0, {}, {}};
const ClpvLight kPoint{{5, 1.5f, 0.3f}, CLPV_LIGHT_POINT, {}, 0, {60, 50, 40}, 0, 0, 0, {}, {}};

reference::MappedLight mapped_light(const ClpvLight& light, const Bounds& bounds, unsigned width,
                                    unsigned height, const std::function<float()>& depth) {
  reference::MappedLight mapped{light, {}};
  for (ClpvView view : shadow_views(light, bounds, static_cast<int>(width))) {
    view.height = height;
    std::vector<float>& depths = mapped.maps.emplace_back(reference::ShadowMap{view, {}}).depth;
    std::generate_n(std::back_inserter(depths), width * height, depth);
  }
  return mapped;
}

std::vector<reference::MappedLight> lights_in(const ClpvMedium& medium) {
  const ClpvLight point{{1, 1.5f, -2.3f}, CLPV_LIGHT_POINT, {}, 0, {6, 5, 4}, 0, 0, 0, {}, {}};
  const ClpvLight spot{
      {-1, 2.5f, -3}, CLPV_LIGHT_SPOT, {0.6f, -0.8f, 0}, 9, {20, 30, 20}, 2, -1, 0, {}, {}};
  reference::MappedLight unshadowed{spot, {}};
  unshadowed.light.medium = medium;
  return {mapped(kSun, medium, 0), mapped(kSun, medium, 1e-3f), mapped(point, medium, 0),
          unshadowed};
}

std::vector<ShadowedLight> on_device(Session& session,
                                     const std::vector<reference::MappedLight>& lights) {
  std::vector<ShadowedLight> shadowed;
  for (const reference::MappedLight& light : lights) {
    ShadowedLight& there = shadowed.emplace_back(ShadowedLight{light.light, {}, {}});
    for (const reference::ShadowMap& map : light.maps) {
      there.views.push_back(map.view);
      there.depths.push_back(session.upload(map.depth, "check: shadow map"));
    }
    there.view_table = session.upload(there.views, "check: views of a light");
  }
  return shadowed;
}

namespace {

constexpr double kUndetermined = 1e-3;  // share of a coefficient that the directions do not see
constexpr double kRidge = 1e-9;         // keeps a matrix of rank less than full invertible

Ranges ranges_within(std::span<const double> expected, double tolerance) {
  Ranges ranges;
  for (const double value : expected)
    ranges.push_back(std::isnan(value) ? Range{} : Range{value - tolerance, value + tolerance});
  return ranges;
}

/// Largest error of each coefficient, for errors of functions of at most 1 in all directions.
std::vector<double> coefficient_errors(const std::vector<std::vector<double>>& rows) {
  const int n = rows.front().size(), m = rows.size();
  Matrix b(m, n);
  for (int i = 0; i < m; ++i) std::ranges::copy(rows[i], b.row(i).begin());
  Matrix normal = transposed(b) * b;
  double trace = 0;
  for (int i = 0; i < n; ++i) trace += normal(i, i);
  for (int i = 0; i < n; ++i) normal(i, i) += kRidge * trace;
  const Matrix solve = inverse(normal) * transposed(b), seen = solve * b;
  std::vector<double> errors;
  for (int i = 0; i < n; ++i) {
    double sum = 0;
    for (const double factor : solve.row(i)) sum += std::abs(factor);
    errors.push_back(std::abs(seen(i, i) - 1) < kUndetermined ? sum : HUGE_VAL);
  }
  return errors;
}

/// Four numbers of each pixel, the last of any value.
void expect_field(Session& session, const Buffer& buffer, const std::vector<glm::vec4>& field,
                  const std::vector<bool>& uncertain, double allowed) {
  if (field.empty()) return;
  std::vector<double> expected;
  for (std::size_t i = 0; i < field.size(); ++i)
    for (int k = 0; k < 4; ++k)
      expected.push_back(uncertain[i] || k == 3 ? NAN : double{field[i][k]});
  expect(session, buffer, "float", ranges_about(expected, allowed));
}

}  // namespace

Ranges ranges_about(std::span<const double> expected, double allowed) {
  double largest = 0;
  for (const double value : expected)
    if (!std::isnan(value)) largest = std::max(largest, std::abs(value));
  return ranges_within(expected, allowed * largest);
}

void expect(Session& session, const Volume& volume, const Ranges& ranges) {
  if (session.recorder() == nullptr) return;
  const VolumeFormat& format = volume.format();
  const VolumeShape& shape = volume.shape();
  Ranges stored(stored_numbers(format, shape));
  std::size_t host = 0;
  for (int channel = 0; channel < shape.channels; ++channel)
    for (int i = 0; i < shape.coefficients; ++i)
      for (int cell = 0; cell < shape.n * shape.n * shape.n; ++cell)
        stored[stored_index(format, shape, channel, i, cell % shape.n, cell / shape.n % shape.n,
                            cell / shape.n / shape.n)] = ranges[host++];
  session.recorder()->expect(volume.memory(), format.storage == Storage::float16 ? "half" : "float",
                             stored);
}

void expect(Session& session, const Buffer& buffer, const char* type, const Ranges& ranges) {
  if (session.recorder() != nullptr) session.recorder()->expect(buffer.handle(), type, ranges);
}

void expect_functions(Session& session, const Volume& volume, std::span<const double> expected,
                      std::span<const double> other,
                      const std::function<std::vector<double>(const glm::dvec3&)>& weights,
                      double allowed) {
  if (session.recorder() == nullptr) return;
  const std::size_t n = volume.shape().n, samples = n * n * n, size = volume.shape().coefficients;
  std::vector<std::vector<double>> rows;
  for (const glm::dvec3& w : compared_directions()) rows.push_back(weights(w));
  double largest = 0;
  for (const std::vector<double>& b : rows) {
    for (std::size_t at = 0; at < expected.size() / size; ++at) {
      double value = 0;
      for (std::size_t i = 0; i < size; ++i)
        value += b[i] * expected[(at / samples * size + i) * samples + at % samples];
      largest = std::max(largest, std::abs(value));
    }
  }
  const std::vector<double> errors = coefficient_errors(rows);
  Ranges ranges;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double error = allowed * largest * errors[i / samples % size];
    ranges.push_back(
        {std::min(expected[i], other[i]) - error, std::max(expected[i], other[i]) + error});
  }
  expect(session, volume, ranges);
}

void expect_depths(Session& session, const Buffer& buffer, const std::vector<float>& expected,
                   const std::vector<bool>& uncertain, double allowed) {
  if (session.recorder() == nullptr) return;
  std::vector<double> depths;
  for (std::size_t i = 0; i < expected.size(); ++i)
    depths.push_back(uncertain[i] ? NAN : double{expected[i]});
  const double deepest = std::max(1.0f, std::ranges::max(expected));
  expect(session, buffer, "float", ranges_within(depths, allowed * deepest));
}

void expect_surface(Session& session, const Surface& surface, const SurfaceImage& expected,
                    const std::vector<bool>& uncertain, double allowed) {
  if (session.recorder() == nullptr) return;
  expect_depths(session, surface.depth, expected.depth, uncertain, allowed);
  expect_field(session, surface.normal, expected.normal, uncertain, allowed);
  expect_field(session, surface.colour, expected.colour, uncertain, allowed);
  if (surface.emissive.exists())
    expect_field(session, surface.emissive, expected.emissive, uncertain, allowed);
}

}  // namespace clpv::verify
