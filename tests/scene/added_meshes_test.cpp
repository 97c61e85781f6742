// SPDX-License-Identifier: MIT
// Meshes from memory: rooms that change are compared with rooms that are made as changed; shared
// slots, rejected arrays.
#include "host/scene/added_meshes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "api/scene_contents.hpp"
#include "clpv/renderer.hpp"
#include "host/scene/bounds.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::added_meshes_test {
using ::testing::HasSubstr;
using Positions = std::vector<std::array<float, 3>>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

const Triangles kSquare{{0, 1, 2}, {0, 2, 3}};
const std::vector<std::array<float, 2>> kCorners{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

/// Floor of 4 m x 4 m at a height, or a wall across z at a distance.
Positions floor_at(float y) {
  return {{-2, y, -2}, {-2, y, 2}, {2, y, 2}, {2, y, -2}};
}
Positions wall_at(float z) {
  return {{-2, 0, z}, {2, 0, z}, {2, 3, z}, {-2, 3, z}};
}

Transform moved_by(double x, double y, double z) {
  Transform made = kIdentity;
  made[0][3] = x;
  made[1][3] = y;
  made[2][3] = z;
  return made;
}

const Camera kEye{.eye = {0.3, 1.5, 4}, .target = {0, 1, 0}};

Options small() {
  return test::small_options().set("cascade-size", "4");
}

/// Floor and a red wall, as a scene that is to be compared.
struct Room {
  Scene scene;
  int floor, wall;

  explicit Room(const Positions& wall_positions, const Transform& at = kIdentity,
                bool moves = false) {
    const Positions ground = floor_at(0);
    floor = scene.add_mesh({.positions = ground, .triangles = kSquare});
    Material red;
    red.base_colour = {0.8, 0.1, 0.1, 1};
    red.double_sided = true;
    wall = scene.add_mesh(
        {.positions = wall_positions, .triangles = kSquare, .material = red, .moves = moves}, at);
    scene.set_cameras({kEye});
    scene.set_lights({Light{.direction = {-0.3, -1, -0.4}, .intensity = {10, 10, 10}}});
  }
  std::vector<float> image() const { return Renderer(scene, small()).render().pixels; }
};

TEST(AddedMeshes, AMovedMeshIsThatOfASceneBuiltAnew) {
  Room room(wall_at(-2));
  Renderer renderer(room.scene, small());
  const auto start = renderer.render().pixels;
  for (const float z : {-1.5f, -1.0f, -2.0f}) {
    room.scene.set_positions(room.wall, wall_at(z));
    EXPECT_EQ(renderer.render().pixels, Room(wall_at(z)).image()) << z;
  }
  EXPECT_EQ(renderer.render().pixels, start);
  EXPECT_NE(Room(wall_at(-1)).image(), start);
  room.scene.set_transform(room.wall, moved_by(0.5, 0, 0.25));
  EXPECT_EQ(renderer.render().pixels, Room(wall_at(-2), moved_by(0.5, 0, 0.25)).image());
}

TEST(AddedMeshes, OnlyTheFirstMoveOfAMeshThatWasNotToMoveRebuildsAFrame) {
  Room fixed(wall_at(-2)), room(wall_at(-2), kIdentity, true);
  Renderer of_fixed(fixed.scene, small()), renderer(room.scene, small());
  of_fixed.render();
  renderer.render();
  const auto rebuilds = [](const Room& of, int mesh, double x) {
    const unsigned before = of.scene.contents().rebuilds;
    Scene(of.scene).set_transform(mesh, moved_by(x, 0, 0));
    return of.scene.contents().rebuilds - before;
  };
  EXPECT_EQ(rebuilds(fixed, fixed.wall, 0.1), 1u);
  EXPECT_EQ(rebuilds(fixed, fixed.wall, 0.2), 0u);
  EXPECT_EQ(rebuilds(room, room.wall, 0.1), 0u) << "added with `moves`";
  EXPECT_EQ(rebuilds(room, room.wall, 0.2), 0u);
  EXPECT_EQ(renderer.render().pixels, of_fixed.render().pixels);
  EXPECT_EQ(renderer.render().pixels, Room(wall_at(-2), moved_by(0.2, 0, 0)).image());
  EXPECT_EQ(rebuilds(room, room.scene.add_instance(room.wall, kIdentity), 0.3), 0u)
      << "its copies move too";
  renderer.render();
  EXPECT_GT(ms_of(renderer.stats().times, "propagate"), 0);
  renderer.render();
  EXPECT_EQ(ms_of(renderer.stats().times, "propagate"), 0) << "nothing has moved";
}

TEST(AddedMeshes, AddedInstancesAndRemovedMeshesAreThoseOfASceneBuiltAnew) {
  Room room(wall_at(-2));
  Renderer renderer(room.scene, small());
  const auto start = renderer.render().pixels;
  const int copy = room.scene.add_instance(room.wall, moved_by(0, 0, 1));
  const auto with_copy = renderer.render().pixels;
  EXPECT_NE(with_copy, start);
  room.scene.remove_mesh(room.wall);  // the copy keeps its vertices and its material
  EXPECT_EQ(renderer.render().pixels, Room(wall_at(-2), moved_by(0, 0, 1)).image());
  room.scene.remove_mesh(copy);
  room.scene.add_mesh({.positions = wall_at(-2),
                       .triangles = kSquare,
                       .material = {.base_colour = {0.8, 0.1, 0.1, 1}, .double_sided = true}});
  EXPECT_EQ(renderer.render().pixels, start);
  EXPECT_THAT(test::error_of(ExitCode::usage, [&] { room.scene.remove_mesh(copy); }),
              HasSubstr("remove_mesh: mesh: found 2"));
}

TEST(AddedMeshes, EqualMaterialsAndFreedTexturesShareTheirSlots) {
  AddedMeshes meshes;
  SceneData scene;
  Material::Texture texture{2, 2, std::vector<std::uint8_t>(16, 200)};
  const Positions ground = floor_at(0);
  const auto add = [&](std::uint8_t value) {
    texture.rgba[0] = value;
    return meshes.add({.positions = ground,
                       .triangles = kSquare,
                       .uvs = kCorners,
                       .material = {.texture = texture}},
                      kIdentity, scene);
  };
  const int first = add(1);
  add(1);
  EXPECT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.materials.size(), 1u);
  const int second = add(2);
  EXPECT_EQ(scene.textures.size(), 2u);
  meshes.remove(second, scene);
  EXPECT_EQ(scene.textures[1].rgba.size(), 4u) << "the memory of its texture is free";
  add(3);
  EXPECT_EQ(scene.textures.size(), 2u);
  EXPECT_EQ(scene.materials.size(), 2u);
  meshes.remove(first, scene);
  EXPECT_EQ(scene.textures[0].rgba[0], 1) << "another mesh uses it";
}

TEST(AddedMeshes, SmoothNormalsAreWeightedByAngle) {
  // A corner of a cube at vertex 0: a square of two triangles (45 degrees each) and two squares of
  // one triangle (90 degrees).
  const Positions corner{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}};
  const Triangles triangles{{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {0, 4, 3}};
  AddedMeshes meshes;
  SceneData scene;
  meshes.add({.positions = corner, .triangles = triangles, .smooth = true}, kIdentity, scene);
  for (const Vertex& vertex : scene.vertices) {
    if (vector(vertex.position) != glm::dvec3(0)) continue;
    for (const float component : vertex.normal) EXPECT_NEAR(component, -1 / std::sqrt(3.0), 1e-6);
  }
  EXPECT_EQ(scene.vertices.size(), 5u);
  meshes.add({.positions = corner, .triangles = triangles}, kIdentity, scene);
  EXPECT_EQ(scene.vertices.size(), 5u + 12) << "flat normals: no shared vertices";
}

TEST(AddedMeshes, BadArraysAreRejectedByNameAndIndex) {
  Room room(wall_at(-2));
  const Positions good = wall_at(-2);
  Positions bad = good;
  const auto rejected = [&](const Mesh& mesh, const std::string& what,
                            const Transform& at = kIdentity) {
    EXPECT_THAT(test::error_of(ExitCode::bad_input, [&] { room.scene.add_mesh(mesh, at); }),
                HasSubstr(what));
  };
  rejected({.positions = good, .triangles = Triangles{{0, 1, 2}, {0, 2, 4}}},
           "add_mesh: triangles[1]: found index 4; allowed: 0 to 3");
  rejected({.positions = {}, .triangles = kSquare}, "triangles[0]: found index 0");
  rejected({.positions = good, .triangles = {}}, "triangles: found 0 corners");
  rejected({.positions = good, .triangles = kSquare, .normals = std::span(good).first(3)},
           "normals: found 3 elements; allowed: 4");
  const std::vector<std::array<float, 2>> uvs(4, {0, INFINITY});
  rejected({.positions = good, .triangles = kSquare, .uvs = uvs},
           "uvs[0]: found inf in component 1");
  bad[2][1] = NAN;
  rejected({.positions = bad, .triangles = kSquare}, "positions[2]: found nan in component 1");
  bad[2][1] = 1e8f;
  rejected({.positions = bad, .triangles = kSquare}, "vertex 2 at");
  Transform shear = kIdentity;
  shear[3][0] = 1;
  rejected({.positions = good, .triangles = kSquare}, "transform[3]: found 1, 0, 0, 1", shear);
  shear[1][2] = NAN;
  rejected({.positions = good, .triangles = kSquare}, "transform[1][2]: found nan", shear);
  rejected({.positions = good, .triangles = kSquare, .material = {.base_colour = {1, 2, 1, 1}}},
           "base_colour[1]: found 2");
  const Material::Texture texture{2, 2, {1}};
  rejected(
      {.positions = good, .triangles = kSquare, .uvs = kCorners, .material = {.texture = texture}},
      "texture: found 1 bytes");
  rejected({.positions = good, .triangles = kSquare, .material = {.texture = texture}},
           "uvs: found none beside a texture; allowed: one for each vertex");
  const Triangles many(bounds::kTriangles + 1);
  rejected({.positions = good, .triangles = many}, "more triangles");
  EXPECT_THAT(
      test::error_of(ExitCode::bad_input, [&] { room.scene.set_positions(room.wall, bad); }),
      HasSubstr("set_positions"));
  EXPECT_THAT(test::error_of(ExitCode::bad_input,
                             [&] { room.scene.set_transform(room.wall, moved_by(1e9, 0, 0)); }),
              HasSubstr("set_transform"));
  EXPECT_EQ(room.image(), Room(wall_at(-2)).image()) << "unchanged after errors";
}

}  // namespace clpv::added_meshes_test
