// SPDX-License-Identifier: MIT
// The methods of Scene for meshes from memory, and textures of Material.
#include "module.hpp"
#include "scene/bounds.hpp"

namespace clpv::python {
namespace {

/// Rows of an array (m, n), or (m, n - 1), whose last column is then 1; without `given`: none.
template <typename T, std::size_t n, typename Given>
std::vector<std::array<T, n>> rows(const char* name, const std::optional<Array<Given>>& given,
                                   bool last_column_may_lack = false) {
  std::vector<std::array<T, n>> all;
  if (!given || (given->ndim() == 1 && given->size() == 0)) return all;
  const auto columns = given->ndim() == 2 ? static_cast<std::size_t>(given->shape(1)) : 0;
  if (columns != n && !(last_column_may_lack && columns == n - 1))
    reject(
        name, "", "shape " + shape_text(*given),
        fmt::format("(n, {}){}", n, last_column_may_lack ? fmt::format(" or (n, {})", n - 1) : ""));
  all.resize(static_cast<std::size_t>(given->shape(0)));
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      const Given value = k < columns ? given->data()[i * columns + k] : Given{1};
      if (std::is_integral_v<T> && (value < 0 || value >= static_cast<Given>(bounds::kVertices)))
        reject(fmt::format("{}[{}]", name, i), "", fmt::format("index {}", value),
               "the index of a vertex, from 0");
      all[i][k] = static_cast<T>(value);
    }
  }
  return all;
}

using Floats = std::optional<FloatArray>;

int add_mesh(Scene& scene, const FloatArray& positions, const Array<std::int64_t>& triangles,
             const Floats& normals, const Floats& uvs, const Floats& colours, bool smooth,
             const std::optional<Material>& material, const std::optional<Transform>& transform,
             bool moves) {
  const auto p = rows<float, 3>("positions", Floats(positions));
  const auto t = rows<std::uint32_t, 3>("triangles", std::optional(triangles));
  const auto n = rows<float, 3>("normals", normals);
  const auto uv = rows<float, 2>("uvs", uvs);
  const auto c = rows<float, 4>("colours", colours, true);
  const Mesh mesh{p, t, n, uv, c, smooth, material.value_or(Material()), moves};
  const WithoutGil released;
  return scene.add_mesh(mesh, transform.value_or(kIdentity));
}

/// uint8: sRGB-encoded, as they are; floats: linear, encoded.
Material::Texture texture_of(const py::array& given) {
  const bool bytes = given.dtype().equal(py::dtype::of<std::uint8_t>());
  if (given.ndim() != 3 || given.shape(2) != 4 || (!bytes && given.dtype().kind() != 'f'))
    throw py::type_error("allowed: uint8 or floats, (height, width, 4)");
  if (bytes) return given.cast<Material::Texture>();
  const auto values = given.cast<FloatArray>();
  Image image;
  image.width = static_cast<int>(values.shape(1)), image.height = static_cast<int>(values.shape(0));
  image.channels = {"R", "G", "B", "A"};
  image.pixels.assign(values.data(), values.data() + values.size());
  return Material::Texture::of(image);
}

}  // namespace

void add_meshes(py::module_& module, py::class_<Scene>& type) {
  module.def("_texture", &texture_of);
  const auto mesh_arguments = [](const auto& define, const auto& function, const char* doc) {
    define(function, py::arg("positions"), py::arg("triangles"), py::kw_only(),
           py::arg("normals") = py::none(), py::arg("uvs") = py::none(),
           py::arg("colours") = py::none(), py::arg("smooth") = false,
           py::arg("material") = py::none(), py::arg("transform") = py::none(),
           py::arg("moves") = false, doc);
  };
  mesh_arguments(
      [&](const auto&... all) { type.def("add_mesh", all...); }, &add_mesh,
      "Returns a number for the mesh, which is not used again.\n\n"
      "positions: array (n, 3) [m], y up; triangles: integers (m, 3), counter-clockwise\n"
      "seen from the front; normals (n, 3), of any length; uvs: texture coordinates\n"
      "(n, 2), v = 0 in the first row; colours: linear (n, 3) or (n, 4), 0 to 1. Without\n"
      "normals: flat ones, as in glTF, or, if smooth, means of the triangles' normals,\n"
      "weighted by angle. material: None for white; transform: array (4, 4) to the\n"
      "world, which multiplies columns (x, y, z, 1). moves: it will move, so its first\n"
      "move needs no new memory (set_positions()). The arrays are copied. Raises\n"
      "InputError with array, index, value found and value allowed.");
  mesh_arguments([&](const auto&... all) { type.def_static("from_arrays", all...); },
                 [](const FloatArray& positions, const Array<std::int64_t>& triangles,
                    const Floats& normals, const Floats& uvs, const Floats& colours, bool smooth,
                    const std::optional<Material>& material,
                    const std::optional<Transform>& transform, bool moves) {
                   Scene scene;
                   add_mesh(scene, positions, triangles, normals, uvs, colours, smooth, material,
                            transform, moves);
                   return scene;
                 },
                 "A scene of one mesh, number 0, as add_mesh() describes it.");
  type.def_static(
      "from_trimesh",
      [](const py::object& given) {
        return py::module_::import("clpv._trimesh").attr("scene_of_trimesh")(given).cast<Scene>();
      },
      py::arg("given"),
      "A scene of a trimesh.Trimesh or trimesh.Scene, [m], y up: geometry, instances, colours and\n"
      "base-colour textures.");
  const py::call_guard<WithoutGil> guard;
  type.def("add_instance", &Scene::add_instance, guard, py::arg("mesh"), py::arg("transform"),
           "The same mesh at another place; its vertices are shared.");
  type.def("remove_mesh", &Scene::remove_mesh, guard, py::arg("mesh"),
           "Removes a mesh from one of its places.");
  type.def(
      "set_positions",
      [](Scene& scene, int mesh, const FloatArray& positions, const Floats& normals) {
        const auto p = rows<float, 3>("positions", Floats(positions));
        const auto n = rows<float, 3>("normals", normals);
        const WithoutGil released;
        scene.set_positions(mesh, p, n);
      },
      py::arg("mesh"), py::arg("positions"), py::arg("normals") = py::none(),
      "Moves the vertices of a mesh, at all of its places. Normals that were given stay without\n"
      "`normals`. The next frame of each renderer recomputes what animation recomputes; at the\n"
      "first move of a mesh added without `moves`, and after an addition or removal, also its\n"
      "memory and what it caches.");
  type.def("set_transform", &Scene::set_transform, guard, py::arg("mesh"), py::arg("transform"),
           "Moves one place of a mesh. As set_positions().");
}

}  // namespace clpv::python
