// SPDX-License-Identifier: MIT
// Renderer, Volume and pathtrace.
#include "clpv/renderer.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <nlohmann/json.hpp>

#include "clpv/opencl.hpp"
#include "clpv/pathtrace.hpp"
#include "module.hpp"
#include "opencl_handle.hpp"
#include "options/show.hpp"
#include "times/time_record.hpp"

namespace clpv::python {

void ReleaseUnlessForked::operator()(Renderer* renderer) const {
  if (!forked_from_device_use()) delete renderer;
}

namespace {

std::string option_text(const std::string& name, const py::handle& value) {
  py::detail::make_caster<bool> flag;
  if (flag.load(value, false)) return static_cast<bool>(flag) ? "on" : "off";
  if (py::hasattr(value, "__fspath__")) return py::str(value.attr("__fspath__")());
  const bool number = PyNumber_Check(value.ptr()) && !PySequence_Check(value.ptr());
  if (number || py::isinstance<py::str>(value)) return py::str(value);
  throw Error(ExitCode::usage, "Renderer: {}: found {}, allowed: a text, a number, True or False",
              name, std::string(py::str(py::type::of(value))));
}

/// Options from keyword arguments: cascade_size=12.5 is option cascade-size.
Options options_of(const py::kwargs& given) {
  Options options;
  for (const auto& [key, value] : given) {
    std::string name = py::str(key);
    if (name.ends_with('_')) name.pop_back();  // lambda_, since lambda is a keyword
    std::replace(name.begin(), name.end(), '_', '-');
    options.set(name, option_text(key.cast<std::string>(), value));
  }
  return options;
}

py::object dict_of(const Stats& stats) {
  const nlohmann::json all{{"times", stats.times},
                           {"launches", stats.launches},
                           {"waits", stats.waits},
                           {"build", stats.build_ms},
                           {"device_bytes", stats.device_bytes},
                           {"peak_device_bytes", stats.peak_device_bytes}};
  const CallInProgress in_progress;  // of Python's code, which may release the GIL
  return py::module_::import("json").attr("loads")(all.dump());
}

using OfPoints = std::vector<std::array<float, 3>> (Renderer::*)(Vectors, Vectors);

/// Calls `function` for points and a vector of each; `what` names the vectors.
py::array_t<float> at_points(Renderer& renderer, OfPoints function, const FloatArray& positions,
                             const FloatArray& along, const char* what) {
  require_vectors(positions, "points");
  require_vectors(along, what);
  const auto shape = shape_with_last(positions, 3);
  if (along.ndim() > 1 && shape != shape_with_last(along, 3)) {
    throw Error(ExitCode::usage, "{}: found shape {}, allowed: (3,) or that of points, {}", what,
                shape_text(along), shape_text(positions));
  }
  return array_of(
      interruptible([&] { return (renderer.*function)(span_of(positions), span_of(along)); }),
      shape);
}

/// Light of a G-buffer of NumPy arrays.
py::array_t<float> light(Renderer& renderer, const FloatArray& normals,
                         const std::optional<FloatArray>& positions,
                         const std::optional<FloatArray>& depths, const std::optional<Vec3>& eye,
                         const std::optional<CameraChoice>& camera, double time) {
  const auto require = [](const char* what, const py::array& array,
                          const std::vector<py::ssize_t>& shape) {
    if (std::equal(shape.begin(), shape.end(), array.shape(), array.shape() + array.ndim())) return;
    throw Error(ExitCode::usage, "{}: found shape {}, allowed: {}", what, shape_text(array),
                std::string(py::str(py::tuple(py::cast(shape)))));
  };
  if (normals.ndim() != 3 || normals.shape(2) != 3)
    throw Error(ExitCode::usage, "normals: found shape {}, allowed: (height, width, 3)",
                shape_text(normals));
  if (positions.has_value() == depths.has_value())
    throw Error(ExitCode::usage, "positions and depths: found {}, allowed: one of them",
                depths ? "both" : "neither");
  GBuffer surfaces{.width = static_cast<int>(normals.shape(1)),
                   .height = static_cast<int>(normals.shape(0)),
                   .normals = span_of(normals)};
  if (positions) {
    require("positions", *positions, shape_with_last(normals, 3));
    surfaces.positions = span_of(*positions);
  } else {
    require("depths", *depths, {normals.shape(0), normals.shape(1)});
    surfaces.depths = std::span(depths->data(), static_cast<std::size_t>(depths->size()));
  }
  const auto found = seen_from(
      eye, camera, [&](const auto& place) { return renderer.light(surfaces, place, time); });
  return array_of(found, shape_with_last(normals, 3));
}

void add_volume(py::module_& module) {
  py::class_<LightVolume> type(module, "Volume",
                               "Light of one cascade after propagation: n^3 cubic cells.");
  type.def_readonly("origin", &LightVolume::origin, "Minimum corner x, y, z [m].");
  type.def_readonly("cell", &LightVolume::cell, "Edge of a cell [m].");
  type.def_readonly(
      "basis", &LightVolume::basis,
      "Name of the basis of the coefficients: sh3 after a sweep, else that of option basis.");
  type.def_property_readonly(
      "coefficients",
      [](const py::object& self) {
        const auto& v = self.cast<const LightVolume&>();
        return py::array_t<float>({3, v.coefficients, v.n, v.n, v.n}, v.values.data(), self);
      },
      "float32 array (3, N, z, y, x): red, green, blue; N coefficients c_i of radiant intensity\n"
      "I(w) = sum_i c_i b_i(w) [W/sr], w the direction in which light travels. After a sweep I /\n"
      "cell^2 is the radiance [W/m^2/sr] about the cell's centre.");
  type.def("__repr__", [](const LightVolume& v) {
    return fmt::format("Volume(origin=({}), cell={}, n={}, basis='{}')", fmt::join(v.origin, ", "),
                       v.cell, v.n, v.basis);
  });
}

}  // namespace

void add_renderer(py::module_& module) {
  add_volume(module);
  RendererClass type(
      module, "Renderer",
      "Renders frames of one scene on one OpenCL device.\n\n"
      "device: an index, 'PLATFORM:DEVICE' or a part of the name; empty: CLPV_DEVICE, else the\n"
      "first usable one. context, queue: of pyopencl, or their int_ptr; the renderer works there.\n"
      "The queue is in-order. options: those of `clpv render` with _ for - (and lambda_);\n"
      "options() lists them. bool is on or off. Results that do not change are cached from frame\n"
      "to frame. Calls from several threads run one after the other. Raises UsageError,\n"
      "DeviceError, ResourceError.");
  type.def(py::init([](const Scene& scene, const std::string& device, const py::object& context,
                       const py::object& queue, const py::kwargs& given) {
             const Options options = options_of(given);
             const bool own = context.is_none() && queue.is_none();
             if (!own && !device.empty())
               throw Error(ExitCode::usage,
                           "device: found one and a context or queue, allowed: one of both");
             const opencl::Queue where{handle_of<cl_context>(context, "context", kContextClass),
                                       handle_of<cl_command_queue>(queue, "queue", kQueueClass)};
             note_device_use();
             return interruptible([&] {
               return own ? Renderer(scene, options, device) : Renderer(scene, options, where);
             });
           }),
           py::arg("scene"), py::arg("device") = "", py::kw_only(), py::arg("context") = py::none(),
           py::arg("queue") = py::none());
  type.def(
      "render",
      [](Renderer& renderer, View view, const std::optional<CameraChoice>& camera, double time,
         const ImageSize& size) {
        return interruptible(
            [&] { return renderer.render(view, camera.value_or(CameraChoice()), time, size); });
      },
      py::arg("view") = "full", py::arg("camera") = py::none(), py::arg("time") = 0.0,
      py::arg("size") = py::none(),
      "A frame as an image (height, width, 4), linear R, G, B, A.\n\n"
      "view: full, direct, indirect, medium [W/m^2/sr], irradiance [W/m^2], albedo, normal,\n"
      "depth [m], or cells: irradiance with the finest cascade's cells as spheres; camera: a\n"
      "Camera, or the name of one of the scene (None: its first); time [s] of an animated scene;\n"
      "size: (width, height), None for options width and height.");
  type.def(
      "update",
      [](Renderer& renderer, const Vec3& eye, double time) {
        interruptible([&] { renderer.update(eye, time); });
      },
      py::arg("eye"), py::arg("time") = 0.0,
      "Lights cascades about `eye` [m] without a frame, for irradiance(),\n"
      "radiance(), volumes() and device_volumes().");
  const auto release = [](Renderer& renderer) { interruptible([&] { renderer.release(); }); };
  type.def("release", release,
           "Frees the device's memory; the next call that lights or renders allocates it "
           "again. A `with` block ends with it.");
  type.def("__enter__", [](Renderer& self) -> Renderer& { return self; });
  type.def("__exit__", [release](Renderer& renderer, const py::args&) { release(renderer); });
  type.def(
      "show",
      [](Renderer& renderer, View view) {
        return interruptible([&] { return renderer.show(view); });
      },
      py::arg("view"), "Another view of the last frame, without rendering it again.");
  type.def(
      "light", &light, py::arg("normals"), py::kw_only(), py::arg("positions") = py::none(),
      py::arg("depths") = py::none(), py::arg("eye") = py::none(), py::arg("camera") = py::none(),
      py::arg("time") = 0.0,
      "Irradiance of indirect light [W/m^2] on the pixels of a G-buffer, with the near field, as\n"
      "view 'irradiance' has it: normals (height, width, 3) of any length; positions [m] of their\n"
      "shape, or depths (height, width) [m] of `camera`, a Camera or a name (None: the scene's\n"
      "first). Cascades surround `eye`, or the camera's. Pixels with a normal of 0, a depth that\n"
      "is not positive or a number that is not finite have no surface, and no light.");
  type.def(
      "irradiance",
      [](Renderer& renderer, const FloatArray& points, const FloatArray& normals) {
        return at_points(renderer, &Renderer::irradiance, points, normals, "normals");
      },
      py::arg("points"), py::arg("normals"),
      "Indirect light [W/m^2], red, green, blue, as an array of the points' shape.\n\n"
      "points [m] and normals (of any length): arrays (..., 3), or one normal. Of the volumes of\n"
      "the last frame, light() or update(), without option near; 0 outside of the cascades.\n"
      "Computed on the device.");
  type.def(
      "radiance",
      [](Renderer& renderer, const FloatArray& points, const FloatArray& directions) {
        return at_points(renderer, &Renderer::radiance, points, directions, "directions");
      },
      py::arg("points"), py::arg("directions"),
      "Indirect light [W/m^2/sr], red, green, blue, as an array of the points' shape.\n\n"
      "points [m] and directions in which the light travels (of any length): arrays (..., 3), or\n"
      "one direction. As irradiance(), of the same volumes, on the device; negative where nine\n"
      "harmonics undershoot. Raises UsageError without transport 'sweep', and for layout 'image'\n"
      "with gather 'all'.");
  type.def("__repr__",
           [](const Renderer& renderer) { return "Renderer(" + renderer.description() + ")"; });
  type.def(
      "volumes",
      [](Renderer& renderer) { return interruptible([&] { return renderer.volumes(); }); },
      "Light of the last frame, finest cascade first.");
  type.def_property_readonly(
      "stats",
      [](const Renderer& renderer) {
        return dict_of(interruptible([&] { return renderer.stats(); }));
      },
      "Dict of the last frame: 'times', a list of records {stage, cascade, light, n, min, median,\n"
      "mad, max} [ms], which ms_of() sums by stage: 'frame' (wall time of render()), 'host' (the\n"
      "host's work in it, without waiting), and each stage on the device that ran ('propagate',\n"
      "'gather', ...); 'build': compilation so far [ms]; numbers of 'launches' (kernels, fills\n"
      "and copies) and of 'waits' for the device; 'device_bytes', 'peak_device_bytes'.");
  add_opencl(module, type);
  module.def("_views", &names_of<View>, "Names of all views.");
  module.def(
      "pathtrace",
      [](const Scene& scene, const std::variant<View, std::vector<View>>& view,
         const std::optional<CameraChoice>& camera, int width, int height,
         const std::variant<int, std::string>& bounces, std::uint32_t samples, double noise,
         std::uint64_t seed, int threads, double time,
         const std::optional<py::function>& progress) {
        const View* one = std::get_if<View>(&view);
        const auto views = one ? std::vector{*one} : std::get<std::vector<View>>(view);
        TraceOptions options{width, height, bounces_of(bounces), samples, noise, seed, threads,
                             time,  {}};
        note_device_use();
        std::atomic<double> reached{0};
        double told = 0;
        options.progress = [&](double now) { reached = now; };
        const auto tell = [&] {
          if (!progress || reached == told) return;
          told = reached;
          (*progress)(told);
        };
        return interruptible(
            [&] { return pathtrace(scene, views, camera.value_or(CameraChoice()), options); },
            tell);
      },
      py::arg("scene"), py::arg("view") = "full", py::arg("camera") = py::none(),
      py::arg("width") = 960, py::arg("height") = 540, py::arg("bounces") = "all",
      py::arg("samples") = 0, py::arg("noise") = 0.02, py::arg("seed") = 1, py::arg("threads") = 0,
      py::arg("time") = 0.0, py::arg("progress") = py::none(),
      "Ground truth on the CPU, as an image (height, width, 4).\n\n"
      "view: as of render(), or a list of several, which become layers of the image: channels\n"
      "'indirect.R' and so on; bounces: reflections between light and visible surface, 'all' or 0\n"
      "for all; samples: paths per pixel, 0 for as many as `noise` (relative standard error of\n"
      "the indirect light) needs; threads: 0 for one per processor. progress: a function that\n"
      "gets the estimated progress, 0 to 1, in this thread, up to 50 times a second; what it\n"
      "raises ends the work.");
}

}  // namespace clpv::python
