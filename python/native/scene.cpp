// SPDX-License-Identifier: MIT
// Scene.

#include "scene/scene.hpp"

#include <charconv>
#include <shared_mutex>

#include "api/scene_contents.hpp"
#include "clpv/pathtrace.hpp"
#include "module.hpp"

namespace clpv::python {

namespace {

py::dict pathtrace_points_of(const Scene& scene, const FloatArray& positions,
                             const FloatArray& normals,
                             const std::variant<int, std::string>& bounces, std::uint32_t samples,
                             double noise, std::uint64_t seed, int threads, double time) {
  require_vectors(positions, "positions");
  require_vectors(normals, "normals");
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

void add_scene(py::module_& module) {
  py::class_<Scene> type(module, "Scene",
                         "Scene(path, model=None): a scene file (.json) or a glTF model (.gltf, "
                         ".glb); `model` replaces that of the file.\n\n"
                         "Renderers keep its data alive. Thread-safe. Raises InputError with file, "
                         "place, value found and value allowed.");
  using Path = std::optional<std::filesystem::path>;
  type.def(py::init([](const Path& path, const Path& model) {
             if (!path && model)
               throw Error(ExitCode::usage, "model: found one, allowed: none without a path");
             if (!path) return Scene();
             return interruptible([&] { return Scene(*path, model.value_or("")); });
           }),
           py::arg("path") = py::none(), py::arg("model") = py::none());
  add_meshes(module, type);
  type.def(
      "__repr__",
      [](const Scene& scene) {
        const std::shared_lock lock(scene.contents().mutex);
        const SceneData& data = scene.contents().moving.scene();
        return fmt::format("Scene('{}', {} triangles, {} cameras, {} lights)", data.path,
                           data.triangles.size(), data.cameras.size(), data.lights.size());
      },
      py::call_guard<WithoutGil>());
  const auto setter = [](auto method) {
    return py::cpp_function(method, py::call_guard<WithoutGil>());
  };
  type.def_property(
      "cameras", [](const Scene& scene) { return py::tuple(py::cast(scene.cameras())); },
      setter(&Scene::set_cameras),
      "Tuple of all Cameras, at 0 s if animated. Assign a sequence to replace them.");
  type.def_property(
      "lights", [](const Scene& scene) { return py::tuple(py::cast(scene.lights())); },
      setter(&Scene::set_lights),
      "Tuple of all Lights, at 0 s if animated. Assign a sequence to replace them: the next frame\n"
      "of every renderer of this scene recomputes what depends on them.");
  type.def_property(
      "medium", &Scene::medium, setter(&Scene::set_medium),
      "Its Medium, or None. Assign to replace it: the next frame of every renderer of this scene "
      "allocates its memory again.");
  type.def(
      "set_sky", &Scene::set_sky, py::arg("above"), py::arg("below") = Vec3{},
      py::call_guard<WithoutGil>(),
      "Replaces the sky: radiance (R, G, B) [W/m^2/sr] above and below the horizon; zeros: none.\n"
      "Lights stay. The next frame of each renderer allocates its memory again.");
  type.def("set_sky_map", &Scene::set_sky_map, py::arg("map"), py::arg("scale") = 1.0,
           py::arg("degrees") = 0.0, py::call_guard<WithoutGil>(),
           "The same by an equirectangular map (.exr, .hdr): top row at +y, centre at -z, turned\n"
           "towards +x.");
  type.def(
      "save",
      [](const Scene& scene, const std::filesystem::path& path) {
        interruptible([&] { scene.save(path); });
      },
      py::arg("path"),
      "Writes meshes, materials, cameras and lights at 0 s to a .glb. Logs a warning\n"
      "for a sky, a medium, a camera's only light, number and size of cascades, and an exposure,\n"
      "which glTF has not, and for a scene without lights.");
  type.def_property_readonly("moves", &Scene::moves, "True if anything is animated.");
  type.def_property_readonly(
      "notes", [](const Scene& scene) { return py::tuple(py::cast(scene.notes())); },
      "One sentence for each thing skipped or added by the loader.");
  type.def_property_readonly(
      "bounds", [](const Scene& scene) { return py::tuple(py::cast(scene.bounds())); },
      "Lower and upper corner of the bounding box [m], at 0 s.");
  type.def_property_readonly("exposure", &Scene::exposure,
                             "Exposure of the scene file [EV], or None.");
  type.def(
      "pathtrace_points", &pathtrace_points_of, py::arg("positions"), py::arg("normals"),
      py::kw_only(), py::arg("bounces") = "all", py::arg("samples") = 0, py::arg("noise") = 0.02,
      py::arg("seed") = 1, py::arg("threads") = 0, py::arg("time") = 0.0,
      "Path-traced irradiance [W/m^2], red, green, blue, the truth of Renderer.irradiance().\n\n"
      "positions [m] and normals (of any length; or one for all): arrays (..., 3), on a\n"
      "surface of the scene or in the air. 'indirect', 'direct' (of the scene's lights) and\n"
      "'error', the standard error of 'indirect': float32 arrays of their shape; 'samples':\n"
      "paths per point; 'noise': root mean square of 'error' over that of 'indirect', at which\n"
      "tracing stops. Arguments as for clpv.pathtrace().");
}

int bounces_of(const std::variant<int, std::string>& given) {
  if (const int* number = std::get_if<int>(&given)) return *number;
  const std::string& text = std::get<std::string>(given);
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text != "all" && (error != std::errc() || *end != 0))
    throw Error(ExitCode::usage, "bounces: found '{}', allowed: a number from 0, or 'all'", text);
  return number;
}

}  // namespace clpv::python
