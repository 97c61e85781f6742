// SPDX-License-Identifier: MIT
// Scene.pathtrace_points.
#include "clpv/pathtrace.hpp"
#include "module.hpp"

namespace clpv::python {

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
