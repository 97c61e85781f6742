// SPDX-License-Identifier: MIT
// The list of suites, and helpers that they share.

#include "bench/suites.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "options/render_options.hpp"
#include "scene/scene.hpp"

namespace clpv::bench {

// The scene of benchmarks without a file: boxes for floor, walls and columns, a camera and a sun.

namespace {

constexpr int kHallTriangles = 20000, kColumns = 6, kBoxes = 5 + kColumns, kFaces = 6;

/// Adds one side of a box: the parallelogram corner, corner + u, corner + v, as divisions^2 pairs
/// of triangles.
void add_side(SceneData& scene, const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v,
              int divisions, unsigned material) {
  const glm::vec3 normal = glm::normalize(glm::cross(u, v));
  const auto first = static_cast<unsigned>(scene.vertices.size());
  const auto row = static_cast<unsigned>(divisions + 1);
  for (int j = 0; j <= divisions; ++j) {
    for (int i = 0; i <= divisions; ++i) {
      const float s = static_cast<float>(i) / static_cast<float>(divisions),
                  t = static_cast<float>(j) / static_cast<float>(divisions);
      const glm::vec3 p = corner + s * u + t * v;
      scene.vertices.push_back(
          {{p.x, p.y, p.z}, {normal.x, normal.y, normal.z}, {s, t}, {1.0f, 1.0f, 1.0f, 1.0f}});
    }
  }
  for (unsigned j = 0; j + 1 < row; ++j) {
    for (unsigned i = 0; i + 1 < row; ++i) {
      const unsigned a = first + j * row + i, b = a + 1, c = a + row, d = c + 1;
      scene.triangles.push_back({{a, b, d}, material});
      scene.triangles.push_back({{a, d, c}, material});
    }
  }
}

void add_box(SceneData& scene, const glm::vec3& lower, const glm::vec3& upper, int divisions,
             const glm::vec3& albedo) {
  const auto material = static_cast<unsigned>(scene.materials.size());
  scene.materials.push_back(
      {{albedo.x, albedo.y, albedo.z, 1.0f}, {0, 0, 0}, 0, CLPV_NO_TEXTURE, CLPV_NO_TEXTURE, 0, 0});
  const glm::vec3 size = upper - lower;
  const glm::vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  add_side(scene, lower, y, x, divisions, material);      // towards -z
  add_side(scene, lower + z, x, y, divisions, material);  // +z
  add_side(scene, lower, z, y, divisions, material);      // -x
  add_side(scene, lower + x, y, z, divisions, material);  // +x
  add_side(scene, lower, x, z, divisions, material);      // -y
  add_side(scene, lower + y, z, x, divisions, material);  // +y
}

/// Makes a hall of 24 x 10 x 24 m without a roof, with one camera and one sun. Its evenly
/// tessellated boxes have about `triangles` triangles, at least 132.
SceneData make_hall(int triangles) {
  const int divisions =
      std::max(1, static_cast<int>(std::lround(std::sqrt(triangles / (2.0 * kFaces * kBoxes)))));
  SceneData scene;
  scene.name = "hall";
  constexpr float kHalf = 12, kThick = 0.5f, kHeight = 10;
  const glm::vec3 stone(0.7f, 0.65f, 0.6f);
  add_box(scene, {-kHalf, -kThick, -kHalf}, {kHalf, 0, kHalf}, divisions, stone);
  add_box(scene, {-kHalf, 0, -kHalf}, {-kHalf + kThick, kHeight, kHalf}, divisions,
          {0.7f, 0.2f, 0.15f});
  add_box(scene, {kHalf - kThick, 0, -kHalf}, {kHalf, kHeight, kHalf}, divisions,
          {0.2f, 0.5f, 0.2f});
  add_box(scene, {-kHalf, 0, -kHalf}, {kHalf, kHeight, -kHalf + kThick}, divisions, stone);
  add_box(scene, {-kHalf, 0, kHalf - kThick}, {kHalf, kHeight, kHalf}, divisions, stone);
  for (int i = 0; i < kColumns; ++i) {
    const glm::vec3 foot(i % 2 == 0 ? -5 : 5, 0, -6 + 5 * (i / 2));
    add_box(scene, foot - glm::vec3(0.6f, 0, 0.6f), foot + glm::vec3(0.6f, 7, 0.6f), divisions,
            stone);
  }
  scene.lower = {-kHalf, -kThick, -kHalf};
  scene.upper = {kHalf, kHeight, kHalf};
  SceneCamera camera;
  camera.name = "hall";
  camera.eye = {0.3f, 2.2f, 9};
  camera.forward = glm::normalize(glm::vec3(-0.05f, -0.1f, -1));
  const glm::vec3 right = glm::normalize(glm::cross(camera.forward, glm::vec3(0, 1, 0)));
  camera.up = glm::cross(right, camera.forward);
  scene.cameras.push_back(camera);
  SceneLight sun{"sun", {}};
  const glm::vec3 down = glm::normalize(glm::vec3(0.45f, -1, 0.2f));
  for (int a = 0; a < 3; ++a) {
    sun.data.direction[a] = down[a];
    sun.data.intensity[a] = a == 2 ? 9 : 10;
  }
  sun.data.kind = CLPV_LIGHT_DIRECTIONAL;
  scene.lights.push_back(sun);
  return scene;
}

}  // namespace

const std::vector<Suite>& suites() {
  static const std::vector<Suite> all = {table1_suite(), layouts_suite(), bases_suite(),
                                         ceilings_suite(), frame_suite()};
  return all;
}

Problem basis_problem(const SuiteOptions& options, const std::string& basis) {
  Problem problem;
  problem.options = options.settings;
  problem.options.basis = basis;
  return problem;
}

RenderOptions published_options(const RenderOptions& sizes, const std::string& basis) {
  RenderOptions options;
  apply_preset(options, PresetName::paper);
  options.basis = basis;
  options.grid = sizes.grid, options.iterations = sizes.iterations;
  options.cascades = sizes.cascades, options.cascade_size = sizes.cascade_size;
  options.rsm_size = sizes.rsm_size;
  options.width = sizes.width, options.height = sizes.height;
  return options;
}

std::vector<Row> pass_rows(const FrameTimes& times, const Row& frame) {
  std::vector<Row> rows;
  for (const auto& [pass, ms] : times.passes()) {
    Row row = frame;
    row.stage = pass;
    row.name = pass + frame.name.substr(frame.name.find('/'));
    row.samples_ms = ms;
    row.times = statistics_of(ms);
    row.wall_ms = row.cpu_ms = row.first_launch_ms = row.build_ms = 0;
    row.from_events = times.from_events();
    row.max_rel_error.reset();  // the frame's error is that of the image, not of a pass
    row.cost = {};
    row.ceiling.clear();
    row.ceiling_share = 0;
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string error_text(const Row& row) {
  return row.max_rel_error ? fmt::format("{:.1e}", *row.max_rel_error) : "-";
}

std::size_t name_width(const std::vector<Row>& rows) {
  std::size_t width = 4;
  for (const Row& row : rows) width = std::max(width, row.name.size());
  return width;
}

std::string row_lines(const std::vector<Row>& rows, std::size_t width,
                      const std::function<std::string(const Row&)>& columns) {
  std::string text;
  for (const Row& row : rows) {
    const bool timed = row.status == Status::ok || row.status == Status::wrong;
    text +=
        fmt::format("{:<{}} {}{}\n", row.name, width,
                    timed ? columns(row) : fmt::format("{}: {}", name_of(row.status), row.reason),
                    row.status == Status::wrong ? "  WRONG: " + row.reason : "");
  }
  return text;
}

std::shared_ptr<const SceneData> scene_of(const SuiteOptions& options) {
  if (options.scene) return options.scene;
  return std::make_shared<const SceneData>(make_hall(kHallTriangles));
}

std::shared_ptr<Bench> make_bench(Session& session, const SuiteOptions& options,
                                  const RenderOptions& settings) {
  const auto make_inputs = [&session, options, settings] {
    const auto scene = scene_of(options);
    return std::make_shared<Inputs>(session, *scene, scene->camera(options.camera), settings);
  };
  return std::make_shared<Bench>(Bench{session, make_inputs, {}, {}});
}

}  // namespace clpv::bench
