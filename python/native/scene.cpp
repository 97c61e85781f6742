// SPDX-License-Identifier: MIT
// Camera, Light and Scene.

#include "scene/scene.hpp"

#include <shared_mutex>

#include "api/scene_contents.hpp"
#include "clpv/pathtrace.hpp"
#include "module.hpp"

namespace clpv::python {

namespace {

std::string repr(const py::object& object, const std::vector<const char*>& members) {
  std::string text = std::string(py::str(py::type::of(object).attr("__name__"))) + "(";
  for (std::size_t i = 0; i < members.size(); ++i) {
    text += std::string(i > 0 ? ", " : "") + members[i] + "=" +
            std::string(py::repr(object.attr(members[i])));
  }
  return text + ")";
}

py::dict values_of(const py::object& object, const std::vector<const char*>& members) {
  py::dict all;
  for (const char* member : members) all[member] = object.attr(member);
  return all;
}

/// Adds repr, equality, hash and copies, given the names of the constructor's arguments.
template <typename T>
void add_value_methods(py::class_<T>& type, const std::vector<const char*>& members) {
  add_copies(type, members);
  type.def("__hash__", [members](const py::object& self) {
    return py::hash(py::tuple(values_of(self, members).attr("values")()));
  });
  type.def("__repr__", [members](const py::object& self) { return repr(self, members); });
  type.def("__eq__", [members](const py::object& self, const py::object& other) {
    if (!py::isinstance<T>(other)) return false;
    for (const char* member : members) {
      if (!self.attr(member).equal(other.attr(member))) return false;
    }
    return true;
  });
}

void add_camera(py::module_& module) {
  py::class_<Camera> type(
      module, "Camera",
      "Perspective camera. Immutable; replace() makes another. Values are validated on "
      "use.\n\n"
      "eye, target, up: x, y, z [m]; fov: vertical field of view [degrees];\n"
      "near: nearest visible depth [m]; light: name of its only light, empty for all.");
  define_init(
      type,
      [](const Vec3& eye, const Vec3& target, const Vec3& up, double fov, double near,
         std::string name, std::string light) {
        return Camera{eye, target, up, fov, near, std::move(name), std::move(light)};
      },
      py::arg("eye"), py::arg("target"), py::arg("up") = py::make_tuple(0, 1, 0),
      py::arg("fov") = 60.0, py::arg("near") = 0.05, py::arg("name") = "", py::arg("light") = "");
  type.def_property_readonly("eye", [](const Camera& c) { return tuple_of(c.eye); });
  type.def_property_readonly("target", [](const Camera& c) { return tuple_of(c.target); });
  type.def_property_readonly("up", [](const Camera& c) { return tuple_of(c.up); });
  type.def_readonly("fov", &Camera::vertical_fov_degrees);
  type.def_readonly("near", &Camera::near);
  type.def_readonly("name", &Camera::name);
  type.def_readonly("light", &Camera::light);
  add_value_methods(type, {"eye", "target", "up", "fov", "near", "name", "light"});
}

void add_light(py::module_& module) {
  py::class_<Light> type(
      module, "Light",
      "Light without extent. Immutable; replace() makes another. Values are validated on "
      "use.\n\n"
      "kind: 'directional', 'spot' or 'point'; position [m]; direction in which light travels;\n"
      "intensity: red, green, blue, or one number: illuminance [lx = W/m^2] if directional, else "
      "[cd = W/sr];\n"
      "range [m], 0 for no limit; inner_cone, outer_cone: angles of a spot [degrees].");
  define_init(
      type,
      [](const std::string& kind, const Vec3& position, const Vec3& direction,
         const Colour& intensity, double range, double inner, double outer, std::string name) {
        return Light{named<LightKind>("kind", kind),
                     position,
                     direction,
                     colour_of(intensity),
                     range,
                     inner,
                     outer,
                     std::move(name)};
      },
      py::arg("kind") = "directional", py::arg("position") = py::make_tuple(0, 0, 0),
      py::arg("direction") = py::make_tuple(0, -1, 0),
      py::arg("intensity") = py::make_tuple(1, 1, 1), py::arg("range") = 0.0,
      py::arg("inner_cone") = 0.0, py::arg("outer_cone") = 45.0, py::arg("name") = "");
  type.def_property_readonly("kind", [](const Light& l) { return std::string(name_of(l.kind)); });
  type.def_property_readonly("position", [](const Light& l) { return tuple_of(l.position); });
  type.def_property_readonly("direction", [](const Light& l) { return tuple_of(l.direction); });
  type.def_property_readonly("intensity", [](const Light& l) { return tuple_of(l.intensity); });
  type.def_readonly("range", &Light::range);
  type.def_readonly("inner_cone", &Light::inner_cone_degrees);
  type.def_readonly("outer_cone", &Light::outer_cone_degrees);
  type.def_readonly("name", &Light::name);
  add_value_methods(type, {"kind", "position", "direction", "intensity", "range", "inner_cone",
                           "outer_cone", "name"});
}

void add_medium(py::module_& module) {
  py::class_<Medium> type(module, "Medium",
                          "Homogeneous fog or dust in a box. Immutable; replace() makes another. "
                          "Values are validated on use.\n\n"
                          "scattering, absorption: red, green, blue, or one number [1/m]; "
                          "anisotropy: -0.9 to 0.9, above 0 forwards;\n"
                          "box: lower and upper corner [m], None for the scene's bounding box.");
  using Box = std::optional<std::array<Vec3, 2>>;
  define_init(
      type,
      [](const Colour& scattering, const Colour& absorption, double anisotropy, const Box& box) {
        return Medium{colour_of(scattering), colour_of(absorption), anisotropy, box};
      },
      py::arg("scattering") = py::make_tuple(0, 0, 0),
      py::arg("absorption") = py::make_tuple(0, 0, 0), py::arg("anisotropy") = 0.0,
      py::arg("box") = py::none());
  type.def_property_readonly("scattering", [](const Medium& m) { return tuple_of(m.scattering); });
  type.def_property_readonly("absorption", [](const Medium& m) { return tuple_of(m.absorption); });
  type.def_readonly("anisotropy", &Medium::anisotropy);
  type.def_property_readonly("box", [](const Medium& m) -> py::object {
    if (!m.box) return py::none();
    return py::make_tuple(tuple_of((*m.box)[0]), tuple_of((*m.box)[1]));
  });
  add_value_methods(type, {"scattering", "absorption", "anisotropy", "box"});
}

}  // namespace

void add_copies(const py::object& type, const std::vector<const char*>& members) {
  const auto add = [&](const char* name, const auto& function, const char* doc) {
    type.attr(name) = py::cpp_function(function, py::name(name), py::is_method(type), py::doc(doc));
  };
  add(
      "replace",
      [members](const py::object& self, const py::kwargs& changes) {
        py::dict all = values_of(self, members);
        all.attr("update")(changes);
        return py::type::of(self)(**all);
      },
      "replace(**changes): a copy with other values of some arguments.");
  name_errors(type, "replace", Self::typed);
  add(
      "__reduce_ex__",
      [members](const py::object& self, int) {
        const py::object make = py::module_::import("functools").attr("partial");
        return py::make_tuple(make(py::type::of(self), **values_of(self, members)), py::tuple());
      },
      "For copy and pickle.");
}

Vec3 colour_of(const Colour& given) {
  if (const auto* colour = std::get_if<Vec3>(&given)) return *colour;
  Vec3 grey{};
  grey.fill(std::get<double>(given));
  return grey;
}

void add_scene(py::module_& module) {
  add_camera(module);
  add_light(module);
  add_medium(module);
  add_material(module);
  py::class_<Scene> type(module, "Scene",
                         "Scene(path, model=None): a scene file (.json) or a glTF model (.gltf, "
                         ".glb); `model` replaces that of the file.\n\n"
                         "Renderers keep its data alive. Thread-safe. Raises InputError with file, "
                         "place, value found and value allowed.");
  using Path = std::optional<std::filesystem::path>;
  define_init(
      type,
      [](const Path& path, const Path& model) {
        if (!path && model)
          throw Error(ExitCode::usage, "model: found one, allowed: none without a path");
        if (!path) return Scene();
        return interruptible([&] { return Scene(*path, model.value_or("")); });
      },
      py::arg("path") = py::none(), py::arg("model") = py::none());
  add_meshes(type);
  add_points(type);
  type.def("__repr__", [](const Scene& scene) {
    return without_gil([&] {
      const std::shared_lock lock(scene.contents().mutex);
      const SceneData& data = scene.contents().moving.scene();
      return fmt::format("Scene('{}', {} triangles, {} cameras, {} lights)", data.path,
                         data.triangles.size(), data.cameras.size(), data.lights.size());
    });
  });
  type.def_property(
      "cameras", [](const Scene& scene) { return py::tuple(py::cast(scene.cameras())); },
      [](Scene& scene, const py::object& given) {
        const auto cameras =
            argument<std::vector<Camera>>("cameras", given, "a sequence of clpv.Camera");
        without_gil([&] { scene.set_cameras(cameras); });
      },
      "Tuple of all Cameras, at 0 s if animated. Assign a sequence to replace them.");
  type.def_property(
      "lights", [](const Scene& scene) { return py::tuple(py::cast(scene.lights())); },
      [](Scene& scene, const py::object& given) {
        const auto lights =
            argument<std::vector<Light>>("lights", given, "a sequence of clpv.Light");
        without_gil([&] { scene.set_lights(lights); });
      },
      "Tuple of all Lights, at 0 s if animated. Assign a sequence to replace them: the next frame\n"
      "of every renderer of this scene recomputes what depends on them.");
  type.def_property(
      "medium", &Scene::medium,
      [](Scene& scene, const py::object& given) {
        const auto medium = argument<std::optional<Medium>>("medium", given, "clpv.Medium or None");
        without_gil([&] { scene.set_medium(medium); });
      },
      "Its Medium, or None. Assign to replace it: the next frame of every renderer of this scene "
      "allocates its memory again.");
  define(
      type, "save",
      [](const Scene& scene, const std::filesystem::path& path) {
        interruptible([&] { scene.save(path); });
      },
      py::arg("path"),
      "save(path): writes meshes, materials, cameras and lights at 0 s to a .glb. Logs a warning\n"
      "for a sky, a medium, a camera's only light, number and size of cascades, and an exposure,\n"
      "which glTF has not, and for a scene without lights.");
  type.def_property_readonly("moves", &Scene::moves, "True if anything is animated.");
  type.def_property_readonly(
      "notes", [](const Scene& scene) { return py::tuple(py::cast(scene.notes())); },
      "One sentence for each thing skipped or added by the loader.");
  type.def_property_readonly(
      "bounds",
      [](const Scene& scene) {
        const auto bounds = scene.bounds();
        return py::make_tuple(tuple_of(bounds[0]), tuple_of(bounds[1]));
      },
      "Lower and upper corner of the bounding box [m], at 0 s.");
  type.def_property_readonly("exposure", &Scene::exposure,
                             "Exposure of the scene file [EV], or None.");
}

// Scene.pathtrace_points.

int bounces_of(const std::variant<int, std::string>& given) {
  if (const int* number = std::get_if<int>(&given)) return *number;
  if (const std::string& text = std::get<std::string>(given); text != "all")
    throw Error(ExitCode::usage, "bounces: found '{}', allowed: a number from 0, or 'all'", text);
  return 0;
}

namespace {

py::dict pathtrace_points_of(const Scene& scene, const py::object& given_positions,
                             const py::object& given_normals,
                             const std::variant<int, std::string>& bounces, std::uint32_t samples,
                             double noise, std::uint64_t seed, int threads, double time) {
  const FloatArray positions = vectors<FloatArray>(given_positions, "positions"),
                   normals = vectors<FloatArray>(given_normals, "normals");
  note_device_use();
  TraceOptions options;
  options.bounces = bounces_of(bounces), options.samples = samples, options.noise = noise;
  options.seed = seed, options.threads = threads, options.seconds = time;
  const PointLights lights = interruptible(
      [&] { return pathtrace_points(scene, span_of(positions), span_of(normals), options); });
  const std::vector<py::ssize_t> shape = shape_with_last(positions, 3);
  return py::dict(py::arg("indirect") = array_of(lights.indirect, shape),
                  py::arg("direct") = array_of(lights.direct, shape),
                  py::arg("error") = array_of(lights.error, shape),
                  py::arg("samples") = lights.samples, py::arg("noise") = lights.noise);
}

}  // namespace

void add_points(py::class_<Scene>& type) {
  define(type, "pathtrace_points", pathtrace_points_of, py::arg("positions"), py::arg("normals"),
         py::kw_only(), py::arg("bounces") = "all", py::arg("samples") = 0, py::arg("noise") = 0.02,
         py::arg("seed") = 1, py::arg("threads") = 0, py::arg("time") = 0.0,
         "pathtrace_points(positions, normals, *, ...) -> dict: path-traced irradiance [W/m^2],\n"
         "red, green, blue, the truth of Renderer.irradiance().\n\n"
         "positions [m] and normals (of any length; or one for all): arrays (..., 3), on a\n"
         "surface of the scene or in the air. 'indirect', 'direct' (of the scene's lights) and\n"
         "'error', the standard error of 'indirect': float32 arrays of their shape; 'samples':\n"
         "paths per point; 'noise': root mean square of 'error' over that of 'indirect', at which\n"
         "tracing stops. Arguments as for clpv.pathtrace().");
}

}  // namespace clpv::python
