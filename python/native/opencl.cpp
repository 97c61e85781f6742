// SPDX-License-Identifier: MIT
// OpenCL objects: frames, light and volumes as device memory, by integers that pyopencl's
// from_int_ptr() takes.
#include "clpv/opencl.hpp"

#include "module.hpp"
#include "opencl_handle.hpp"
#include "options/show.hpp"

namespace clpv::python {
namespace {

/// A handle as an integer; None for null.
template <typename Handle>
py::object number_of(Handle handle) {
  return handle == nullptr ? py::object(py::none())
                           : py::int_(reinterpret_cast<std::uintptr_t>(handle));
}

void wait_for(const opencl::Event& event) {
  const cl_int code = interruptible([&] { return event.wait(); });
  if (code != CL_SUCCESS)
    throw Error(ExitCode::run_time, "wait: the device's commands failed with OpenCL error {}",
                code);
}

void add_classes(py::module_& module) {
  py::class_<opencl::Event> event(module, "DeviceEvent",
                                  "Completion of commands that were enqueued.");
  event.def_property_readonly(
      "int_ptr", [](const opencl::Event& e) { return number_of(e.get()); },
      "The cl_event, for pyopencl.Event.from_int_ptr(int_ptr, retain=True). It lives as long as "
      "this object.");
  event.def("wait", &wait_for, "Waits for the commands. Raises ResourceError if they failed.");

  py::class_<opencl::Frame> frame(
      module, "DeviceFrame",
      "Device memory of a frame: integers for pyopencl.MemoryObject.from_int_ptr(number, "
      "retain=True), row 0 at the top.\n\n"
      "The renderer's next call that renders overwrites it.");
  frame.def_readonly("width", &opencl::Frame::width, "Pixels of a row.");
  frame.def_readonly("height", &opencl::Frame::height, "Rows.");
  const auto memory = [&](const char* name, cl_mem opencl::Frame::*member, const char* doc) {
    frame.def_property_readonly(
        name, [member](const opencl::Frame& f) { return number_of(f.*member); }, doc);
  };
  memory("image", &opencl::Frame::image,
         "float4 per pixel: R, G, B, A of the view, linear, without a sky.");
  memory("irradiance", &opencl::Frame::irradiance,
         "float4 per pixel: E [W/m^2] of red, green, blue, and 0.");
  memory("depth", &opencl::Frame::depth, "float per pixel [m]; 0 without a surface.");
  memory("normals", &opencl::Frame::normals, "float4 per pixel: unit normal, and 0.");
  frame.def_property_readonly(
      "int_ptr", [](const opencl::Frame& f) { return number_of(f.done.get()); },
      "The cl_event of the whole frame.");
  frame.def(
      "wait", [](const opencl::Frame& f) { wait_for(f.done); },
      "Waits for the frame. Raises ResourceError if it failed.");

  py::class_<opencl::Volumes> volumes(module, "DeviceVolumes",
                                      "Light for a kernel: arguments CLPV_RADIANCE of "
                                      "Renderer.lookup_source(), in the order of arguments().");
  volumes.def(
      "arguments",
      [](const opencl::Volumes& v) {
        const py::module_ numpy = py::module_::import("numpy");
        py::list all;
        all.append(number_of(v.grids));
        all.append(numpy.attr("uint32")(v.cascades));
        all.append(numpy.attr("float32")(v.unit));
        all.append(number_of(v.packed));
        if (v.occluded != nullptr) all.append(number_of(v.occluded));
        return py::tuple(all);
      },
      "(grids, cascades, unit, packed[, occluded]): memory as integers, a "
      "numpy.uint32 and a numpy.float32.");
}

}  // namespace

void add_opencl(py::module_& module, RendererClass& type) {
  add_classes(module);
  type.def(
      "enqueue",
      [](Renderer& renderer, View view, const std::optional<CameraChoice>& camera, double time,
         const ImageSize& size) {
        return interruptible(
            [&] { return renderer.enqueue(view, camera.value_or(CameraChoice()), time, size); });
      },
      py::keep_alive<0, 1>(), py::arg("view") = "full", py::arg("camera") = py::none(),
      py::arg("time") = 0.0, py::arg("size") = py::none(),
      "render() without reading the image back.\n\n"
      "Does not wait for all of the frame (docs/api.md); not for view 'cells'.");
  type.def(
      "enqueue_light",
      [](Renderer& renderer, int width, int height, const py::object& normals,
         const py::object& positions, const py::object& depths, const py::object& irradiance,
         const std::optional<Vec3>& eye, const std::optional<CameraChoice>& camera, double time) {
        const opencl::GBuffer surfaces{width,
                                       height,
                                       handle_of<cl_mem>(normals, "normals", kMemoryClass),
                                       handle_of<cl_mem>(positions, "positions", kMemoryClass),
                                       handle_of<cl_mem>(depths, "depths", kMemoryClass),
                                       handle_of<cl_mem>(irradiance, "irradiance", kMemoryClass)};
        return seen_from(eye, camera, [&](const auto& place) {
          return renderer.enqueue_light(surfaces, place, time);
        });
      },
      py::keep_alive<0, 1>(), py::arg("width"), py::arg("height"), py::kw_only(),
      py::arg("normals"), py::arg("positions") = py::none(), py::arg("depths") = py::none(),
      py::arg("irradiance"), py::arg("eye") = py::none(), py::arg("camera") = py::none(),
      py::arg("time") = 0.0,
      "light() in device memory.\n\n"
      "Buffers of the renderer's context, as pyopencl's buffers or arrays, or integers: normals\n"
      "and positions float4 per pixel (w unused), or depths float; irradiance receives float4.\n"
      "Raises UsageError for others, and for buffers that are too small.");
  type.def(
      "device_volumes",
      [](Renderer& renderer) { return interruptible([&] { return renderer.device_volumes(); }); },
      py::keep_alive<0, 1>(),
      "Light of the last frame or light() for kernels. Raises UsageError as "
      "radiance().");
  type.def(
      "lookup_source", [](const Renderer& renderer) { return renderer.lookup_source(); },
      "OpenCL C for the start of a program, clpv_irradiance() and "
      "clpv_radiance() at a point for kernels with\nthe parameters CLPV_RADIANCE (docs/api.md).");
}

}  // namespace clpv::python
