// SPDX-License-Identifier: MIT
// Material, and the methods of Scene for meshes from memory.
#include <cstring>

#include "module.hpp"
#include "scene/bounds.hpp"
#include "support/error.hpp"

namespace clpv::python {
namespace {

/// Numbers of a mesh, of which the caller may do anything after the call: always a copy, or one
/// that NumPy keeps unchanged while the GIL is held.
template <typename T, std::size_t n>
using Rows = std::vector<std::array<T, n>>;

/// Rejects an array of another kind of numbers ("fiu") or shape, before a conversion allocates
/// memory.
py::array checked(const char* function, const char* name, const py::object& given,
                  std::string_view kinds, std::initializer_list<py::ssize_t> columns) {
  const auto array = real_array<py::array>(given, name);
  if (array.ndim() == 1 && array.size() == 0)  // [] has neither columns nor integers
    return py::array_t<std::uint32_t>(std::vector<py::ssize_t>{0, *columns.begin()});
  if (kinds.find(array.dtype().kind()) == std::string_view::npos) {
    throw Error(ExitCode::usage, "{}: {}: found an array of {}, allowed: {}", function, name,
                std::string(py::str(array.dtype())), kinds == "iu" ? "integers" : "floats");
  }
  std::string allowed;
  for (const py::ssize_t column : columns) {
    if (array.ndim() == 2 && array.shape(1) == column) allowed = "it";
  }
  if (allowed.empty()) {
    for (const py::ssize_t column : columns)
      allowed += fmt::format("{}(n, {})", allowed.empty() ? "" : " or ", column);
    reject(function, name, "shape " + shape_text(array), allowed);
  }
  const auto most = static_cast<py::ssize_t>(bounds::kTriangles);
  static_assert(bounds::kTriangles == bounds::kVertices);
  if (array.shape(0) > most)
    reject(function, name, fmt::format("{} rows", array.shape(0)), fmt::format("at most {}", most));
  return array;
}

/// Rows of n floats; missing columns are 1.
template <std::size_t n>
Rows<float, n> floats(const char* function, const char* name, const py::object& given,
                      std::initializer_list<py::ssize_t> columns = {n},
                      std::string_view kinds = "fiu") {
  if (given.is_none()) return {};
  const auto array = converted<FloatArray>(checked(function, name, given, kinds, columns));
  Rows<float, n> rows(static_cast<std::size_t>(array.shape(0)));
  const auto width = static_cast<std::size_t>(array.shape(1));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].fill(1);
    std::copy_n(array.data() + i * width, width, rows[i].begin());
  }
  return rows;
}

Rows<std::uint32_t, 3> indices(const char* function, const py::object& given) {
  const py::array any = checked(function, "triangles", given, "iu", {3});
  const auto array =
      converted<py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>>(any);
  Rows<std::uint32_t, 3> rows(static_cast<std::size_t>(array.shape(0)));
  for (std::size_t i = 0; i < 3 * rows.size(); ++i) {
    const std::int64_t index = array.data()[i];  // a large unsigned one is negative here
    if (index < 0 || index >= static_cast<std::int64_t>(bounds::kVertices)) {
      const std::string value = any.dtype().kind() == 'u'
                                    ? fmt::format("{}", static_cast<std::uint64_t>(index))
                                    : fmt::format("{}", index);
      reject(function, fmt::format("triangles[{}]", i / 3), "index " + value,
             "the index of a vertex, from 0");
    }
    rows[i / 3][i % 3] = static_cast<std::uint32_t>(index);
  }
  return rows;
}

Transform transform_of(const char* function, const py::object& given) {
  const DoubleArray array = real_array<DoubleArray>(given, "transform");
  if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4)
    reject(function, "transform", "shape " + shape_text(array), "(4, 4)");
  Transform made;
  std::memcpy(&made, array.data(), sizeof made);
  return made;
}

/// uint8: sRGB-encoded; floats: linear.
std::optional<Material::Texture> texture_of(const py::object& given) {
  if (given.is_none()) return std::nullopt;
  const auto array = real_array<py::array>(given, "texture");
  const bool bytes = array.dtype().equal(py::dtype::of<std::uint8_t>());
  if (!bytes && array.dtype().kind() != 'f') {
    throw Error(ExitCode::usage, "texture: found an array of {}, allowed: uint8 or floats",
                std::string(py::str(array.dtype())));
  }
  const py::ssize_t side = bounds::kImageSide;
  if (array.ndim() != 3 || array.shape(2) != 4 || array.shape(0) < 1 || array.shape(1) < 1 ||
      array.shape(0) > side || array.shape(1) > side) {
    reject("Material", "texture", "shape " + shape_text(array),
           fmt::format("(height, width, 4), 1 to {} pixels per side", side));
  }
  if (bytes) {
    const auto values =
        converted<py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast>>(array);
    return Material::Texture{static_cast<std::uint32_t>(array.shape(1)),
                             static_cast<std::uint32_t>(array.shape(0)),
                             {values.data(), values.data() + values.size()}};
  }
  const auto values = converted<FloatArray>(array);
  Image image;
  image.width = static_cast<int>(array.shape(1));
  image.height = static_cast<int>(array.shape(0));
  image.channels = {"R", "G", "B", "A"};
  image.pixels.assign(values.data(), values.data() + values.size());
  return Material::Texture::of(image);
}

/// One number, or red, green, blue and optionally alpha.
using BaseColour = std::variant<double, Vec3, std::array<double, 4>>;

std::array<double, 4> base_colour_of(const BaseColour& given) {
  if (const auto* all = std::get_if<std::array<double, 4>>(&given)) return *all;
  const auto* three = std::get_if<Vec3>(&given);
  const Vec3 colour =
      colour_of(three != nullptr ? Colour(*three) : Colour(std::get<double>(given)));
  return {colour[0], colour[1], colour[2], 1};
}

/// Arrays of a mesh, and the mesh that borrows them.
struct GivenMesh {
  Rows<float, 3> positions, normals;
  Rows<std::uint32_t, 3> triangles;
  Rows<float, 2> uvs;
  Rows<float, 4> colours;
  Mesh mesh;
};

std::unique_ptr<GivenMesh> given_mesh(const py::object& positions, const py::object& triangles,
                                      const py::object& normals, const py::object& uvs,
                                      const py::object& colours, bool smooth,
                                      const std::optional<Material>& material, bool moves) {
  constexpr const char* kFunction = "add_mesh";
  auto given = std::make_unique<GivenMesh>();
  given->positions = floats<3>(kFunction, "positions", positions);
  given->triangles = indices(kFunction, triangles);
  given->normals = floats<3>(kFunction, "normals", normals);
  given->uvs = floats<2>(kFunction, "uvs", uvs);
  given->colours = floats<4>(kFunction, "colours", colours, {3, 4}, "f");
  given->mesh = {given->positions,
                 given->triangles,
                 given->normals,
                 given->uvs,
                 given->colours,
                 smooth,
                 material.value_or(Material()),
                 moves};
  return given;
}

int add_mesh(Scene& scene, const py::object& positions, const py::object& triangles,
             const py::object& normals, const py::object& uvs, const py::object& colours,
             bool smooth, const std::optional<Material>& material, const py::object& transform,
             bool moves) {
  const auto given =
      given_mesh(positions, triangles, normals, uvs, colours, smooth, material, moves);
  const Transform at = transform.is_none() ? kIdentity : transform_of("add_mesh", transform);
  return without_gil([&] { return scene.add_mesh(given->mesh, at); });
}

}  // namespace

void add_material(py::module_& module) {
  py::class_<Material> type(
      module, "Material",
      "Diffuse surface of a mesh. Immutable; replace() makes another. Values are checked where\n"
      "it is used.\n\n"
      "base_colour: linear red, green, blue and optionally alpha, or one number, 0 to 1;\n"
      "emission: radiance of the front [W/m^2/sr], three numbers or one; texture: array (height,\n"
      "width, 4), uint8 with sRGB-encoded colour, or floats, linear; alpha_cutoff: alpha below\n"
      "which there are holes; double_sided: visible, and emissive, from both sides.");
  define_init(
      type,
      [](const BaseColour& base_colour, const Colour& emission, const py::object& texture,
         std::optional<double> alpha_cutoff, bool double_sided) {
        return Material{base_colour_of(base_colour), colour_of(emission), texture_of(texture),
                        alpha_cutoff, double_sided};
      },
      py::kw_only(), py::arg("base_colour") = 1.0, py::arg("emission") = 0.0,
      py::arg("texture") = py::none(), py::arg("alpha_cutoff") = py::none(),
      py::arg("double_sided") = false);
  type.def_property_readonly("base_colour", [](const Material& m) {
    return py::make_tuple(m.base_colour[0], m.base_colour[1], m.base_colour[2], m.base_colour[3]);
  });
  type.def_property_readonly("emission", [](const Material& m) { return tuple_of(m.emission); });
  type.def_property_readonly(
      "texture",
      [](const Material& m) -> py::object {
        if (!m.texture) return py::none();
        py::array_t<std::uint8_t> made(
            {py::ssize_t(m.texture->height), py::ssize_t(m.texture->width), py::ssize_t(4)});
        std::memcpy(made.mutable_data(), m.texture->rgba.data(), m.texture->rgba.size());
        return made;
      },
      "A copy as uint8 array (height, width, 4), or None.");
  add_copies(type, {"base_colour", "emission", "texture", "alpha_cutoff", "double_sided"});
  type.def("__hash__", [](const Material& m) {
    return py::hash(py::make_tuple(py::tuple(py::cast(m.base_colour)), tuple_of(m.emission),
                                   m.texture ? m.texture->width : 0, m.alpha_cutoff,
                                   m.double_sided));
  });
  type.def_readonly("alpha_cutoff", &Material::alpha_cutoff);
  type.def_readonly("double_sided", &Material::double_sided);
  type.def(
      "__eq__", [](const Material& a, const Material& b) { return a == b; }, py::is_operator());
  type.def("__repr__", [](const Material& m) {
    const auto& c = m.base_colour;
    return fmt::format(
        "Material(base_colour=({}, {}, {}, {}), emission=({}, {}, {}), texture={}, "
        "alpha_cutoff={}, "
        "double_sided={})",
        c[0], c[1], c[2], c[3], m.emission[0], m.emission[1], m.emission[2],
        m.texture ? fmt::format("{} x {}", m.texture->width, m.texture->height) : "None",
        m.alpha_cutoff ? fmt::format("{}", *m.alpha_cutoff) : "None",
        m.double_sided ? "True" : "False");
  });
}

void add_meshes(py::class_<Scene>& type) {
  const auto arguments = [](const auto& define, const auto& function, const char* doc) {
    define(function, py::arg("positions"), py::arg("triangles"), py::kw_only(),
           py::arg("normals") = py::none(), py::arg("uvs") = py::none(),
           py::arg("colours") = py::none(), py::arg("smooth") = false,
           py::arg("material") = py::none(), py::arg("transform") = py::none(),
           py::arg("moves") = false, doc);
  };
  arguments([&](const auto&... all) { define(type, "add_mesh", all...); }, &add_mesh,
            "add_mesh(positions, triangles, *, ...) -> int: a number for the mesh, which is not\n"
            "used again.\n\n"
            "positions: array (n, 3) [m], y up; triangles: integers (m, 3), counter-clockwise\n"
            "seen from the front; normals (n, 3), of any length; uvs: texture coordinates (n, 2),\n"
            "v = 0 in the first row; colours: linear floats (n, 3) or (n, 4), 0 to 1. Without\n"
            "normals: flat ones, as in glTF, or, if smooth, means of the triangles' normals,\n"
            "weighted by angle. material: None for white; transform: array (4, 4) to the world,\n"
            "which multiplies columns (x, y, z, 1). moves: it will move, so its first move needs\n"
            "no new memory (set_positions()). The arrays are copied. Raises InputError with\n"
            "array, index, value found and value allowed.");
  arguments([&](const auto&... all) { define_static(type, "from_arrays", all...); },
            [](const py::object& positions, const py::object& triangles, const py::object& normals,
               const py::object& uvs, const py::object& colours, bool smooth,
               const std::optional<Material>& material, const py::object& transform, bool moves) {
              Scene scene;
              add_mesh(scene, positions, triangles, normals, uvs, colours, smooth, material,
                       transform, moves);
              return scene;
            },
            "from_arrays(positions, triangles, *, ...) -> Scene of one mesh, number 0, as "
            "add_mesh() describes it.");
  define_static(
      type, "from_trimesh",
      [](const py::object& given) {
        return py::module_::import("clpv._trimesh").attr("scene_of_trimesh")(given);
      },
      py::arg("given"),
      "from_trimesh(given) -> Scene of a trimesh.Trimesh or trimesh.Scene, [m], y up: geometry,\n"
      "instances, colours and base-colour textures.");
  define(
      type, "add_instance",
      [](Scene& scene, int mesh, const py::object& transform) {
        const Transform at = transform_of("add_instance", transform);
        return without_gil([&] { return scene.add_instance(mesh, at); });
      },
      py::arg("mesh"), py::arg("transform"),
      "add_instance(mesh, transform) -> int: the same mesh at another place; its vertices are "
      "shared.");
  define(
      type, "remove_mesh",
      [](Scene& scene, int mesh) { without_gil([&] { scene.remove_mesh(mesh); }); },
      py::arg("mesh"), "remove_mesh(mesh): removes a mesh from one of its places.");
  define(
      type, "set_positions",
      [](Scene& scene, int mesh, const py::object& positions, const py::object& normals) {
        const auto moved = floats<3>("set_positions", "positions", positions);
        const auto turned = floats<3>("set_positions", "normals", normals);
        without_gil([&] { scene.set_positions(mesh, moved, turned); });
      },
      py::arg("mesh"), py::arg("positions"), py::arg("normals") = py::none(),
      "set_positions(mesh, positions, normals=None): moves its vertices, at all of its places.\n"
      "Normals that were given stay without `normals`. The next frame of each renderer recomputes\n"
      "what animation recomputes; at the first move of a mesh added without `moves`, and after an\n"
      "addition or removal, also its memory and what it caches.");
  define(
      type, "set_transform",
      [](Scene& scene, int mesh, const py::object& transform) {
        const Transform at = transform_of("set_transform", transform);
        without_gil([&] { scene.set_transform(mesh, at); });
      },
      py::arg("mesh"), py::arg("transform"),
      "set_transform(mesh, transform): moves one place of a mesh. As set_positions().");
}

}  // namespace clpv::python
