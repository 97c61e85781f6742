// SPDX-License-Identifier: MIT
// Image, its files, and comparison.
#include "clpv/image.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "clpv/compare.hpp"
#include "image/image.hpp"
#include "image/image_io.hpp"
#include "image/tone_map.hpp"
#include "module.hpp"

namespace clpv::python {
namespace {

std::vector<std::string> usual_channels(py::ssize_t count) {
  if (count == 1) return {"Y"};
  if (count == 3) return {"R", "G", "B"};
  if (count == 4) return {"R", "G", "B", "A"};
  std::vector<std::string> names;
  for (py::ssize_t i = 0; i < count; ++i) names.push_back("channel" + std::to_string(i));
  return names;
}

Image image_from(const char* name, const FloatArray& array,
                 std::optional<std::vector<std::string>> channels, const std::string& encoding) {
  if (array.ndim() != 3 || array.size() == 0 || array.shape(0) > 16384 || array.shape(1) > 16384) {
    throw Error(ExitCode::usage,
                "{}: found shape {}, allowed: (height, width, channels), up to 16384 x 16384", name,
                shape_text(array));
  }
  Image image;
  image.height = static_cast<int>(array.shape(0));
  image.width = static_cast<int>(array.shape(1));
  image.channels = channels ? std::move(*channels) : usual_channels(array.shape(2));
  if (static_cast<py::ssize_t>(image.channels.size()) != array.shape(2)) {
    throw Error(ExitCode::usage,
                "channels: found {} names, allowed: {}, as many as the array has channels",
                image.channels.size(), array.shape(2));
  }
  if (encoding != "linear" && encoding != "srgb")
    throw Error(ExitCode::usage, "encoding: found '{}', allowed: linear|srgb", encoding);
  image.encoding = encoding == "srgb" ? Encoding::srgb : Encoding::linear;
  image.pixels.assign(array.data(), array.data() + array.size());
  check_image(name, image);
  return image;
}

/// Returns true for channels R, G, B and at most A.
bool shows_colour(const Image& image) {
  const std::size_t others = image.channel("A") ? 1 : 0;
  return image.channel("R") && image.channel("G") && image.channel("B") &&
         image.channels.size() == 3 + others;
}

std::vector<py::ssize_t> shape_of(const Image& image) {
  return {image.height, image.width, static_cast<py::ssize_t>(image.channels.size())};
}

/// An Image as it is; an array as a linear image.
using ImageOrArray = std::variant<Image, FloatArray>;
Image given_image(const char* name, const ImageOrArray& given) {
  const auto* image = std::get_if<Image>(&given);
  return image ? *image : image_from(name, std::get<FloatArray>(given), std::nullopt, "linear");
}

void add_comparison(py::module_& module) {
  py::class_<Comparison> type(
      module, "Comparison",
      "Errors of an image against its reference, over the colour channels. None: undefined.");
  type.def_readonly("rmse", &Comparison::rmse, "Root mean square error.");
  type.def_readonly("nrmse", &Comparison::nrmse,
                    "rmse over the root mean square of the reference.");
  type.def_readonly("relative_mse", &Comparison::relative_mse, "Mean of (a - b)^2 / (b^2 + 0.01).");
  type.def_readonly("psnr_db", &Comparison::psnr_db,
                    "Peak signal-to-noise ratio with peak 1 [dB].");
  type.def_readonly("max_error", &Comparison::max_error);
  type.def_readonly("max_error_at", &Comparison::max_error_at, "x, y from the top left corner.");
  type.def_readonly("mean_luminance", &Comparison::mean_luminance,
                    "Of the image and of the reference.");
  type.def_readonly("identical", &Comparison::identical);
  type.def_readonly("valid_pixels", &Comparison::valid_pixels,
                    "Pixels with alpha above 0 in both.");
  type.def_readonly("nrmse_valid", &Comparison::nrmse_valid, "nrmse over valid pixels.");
  type.def_readonly("best_gain", &Comparison::best_gain,
                    "Factor on the image with the least error.");
  type.def_readonly("nrmse_best_gain", &Comparison::nrmse_best_gain, "nrmse with that factor.");
  type.def_readonly("energy_ratio", &Comparison::energy_ratio,
                    "Sum of the image over that of the reference.");
  type.def_readonly("flip", &Comparison::flip,
                    "Mean FLIP, what an observer sees, 0 to 1 (Andersson et al. 2020).");
  type.def("__repr__", [](const Comparison& c) {
    return fmt::format("Comparison(rmse={}, nrmse={}, identical={})", c.rmse,
                       c.nrmse ? fmt::format("{}", *c.nrmse) : "None",
                       c.identical ? "True" : "False");
  });
  module.def(
      "compare",
      [](const ImageOrArray& image, const ImageOrArray& reference, float exposure) {
        const Image a = given_image("image", image), b = given_image("reference", reference);
        return interruptible([&] { return compare(a, b, exposure); });
      },
      py::arg("image"), py::arg("reference"), py::arg("exposure") = 0.0f,
      "Errors of an image. Both: an Image, or an array (height, width, channels).\n"
      "exposure [EV]: of linear images, for FLIP. Raises InputError\n"
      "for other sizes, channels or encodings, and for values that are not finite.");
}

}  // namespace

void add_image(py::module_& module) {
  py::class_<Image> type(
      module, "Image", py::buffer_protocol(),
      "A copy of an array (height, width, channels) of real numbers.\n\n"
      "numpy.asarray(image) and image.array are float32 views of its pixels, row 0 on top,\n"
      "without a copy; they keep the image alive.");
  type.def(py::init([](const FloatArray& array, std::optional<std::vector<std::string>> channels,
                       const std::string& encoding) {
             return image_from("array", array, std::move(channels), encoding);
           }),
           py::arg("array"), py::arg("channels") = py::none(), py::arg("encoding") = "linear");
  type.def_buffer([](Image& image) {
    const auto shape = shape_of(image);
    const py::ssize_t value = sizeof(float);
    return py::buffer_info(image.pixels.data(), value, py::format_descriptor<float>::format(), 3,
                           shape, {shape[1] * shape[2] * value, shape[2] * value, value});
  });
  type.def_property_readonly(
      "array",
      [](const py::object& self) {
        Image& image = self.cast<Image&>();
        return py::array_t<float>(shape_of(image), image.pixels.data(), self);
      },
      "Pixels as a float32 array (height, width, channels), without a copy.");
  type.def_readonly("width", &Image::width);
  type.def_readonly("height", &Image::height);
  type.def_property_readonly(
      "channels", [](const Image& image) { return py::tuple(py::cast(image.channels)); },
      "Names, such as 'R' or 'indirect.R' of layer 'indirect'.");
  type.def_readonly("metadata", &Image::metadata, "Dict of the options that it was rendered with.");
  type.def_property_readonly(
      "notes", [](const Image& image) { return py::tuple(py::cast(image.notes)); },
      "What reading its file converted or ignored.");
  type.def_property_readonly(
      "encoding",
      [](const Image& image) { return image.encoding == Encoding::srgb ? "srgb" : "linear"; },
      "'linear' in light, or 'srgb'.");
  type.def(
      "save",
      [](const Image& image, const std::filesystem::path& path, std::optional<float> exposure) {
        save_image(path, image, exposure);
      },
      py::call_guard<WithoutGil>(), py::arg("path"), py::arg("exposure") = py::none(),
      "Writes a linear image with channels R, G, B and optionally A: .exr as float32 with\n"
      "metadata, .png tone-mapped (photographic) after multiplication by 2^exposure [EV], on a\n"
      "black background. exposure=None: automatic_exposure().");
  type.def("automatic_exposure", &automatic_exposure,
           "Exposure [EV] that brings the logarithmic mean of the luminance of "
           "lit pixels to 0.14.");
  type.def(
      "display",
      [](const Image& image, std::optional<float> exposure) {
        Image shown = display_image(image, exposure ? *exposure : automatic_exposure(image),
                                    kDisplayCurve, Background::transparent);
        const auto shape = shape_of(shown);
        py::array_t<std::uint8_t> bytes(shape);
        std::uint8_t* out = bytes.mutable_data();
        for (std::size_t i = 0; i < shown.pixels.size(); ++i)
          out[i] = static_cast<std::uint8_t>(std::clamp(shown.pixels[i], 0.0f, 1.0f) * 255 + 0.5f);
        return bytes;
      },
      py::arg("exposure") = py::none(),
      "uint8 array (height, width, channels), tone-mapped and sRGB-encoded as save() does for "
      ".png, with A.");
  type.def(
      "_repr_png_",
      [](const Image& image) -> py::object {
        if (!shows_colour(image)) return py::none();
        const auto bytes =
            png_bytes(image.encoding == Encoding::srgb
                          ? image
                          : display_image(image, automatic_exposure(image), kDisplayCurve));
        return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      },
      "How notebooks show it, as save() does; None without R, G, B.");
  type.def("__repr__", [](const Image& image) {
    return fmt::format("Image({} x {}, {}, {})", image.width, image.height,
                       fmt::join(image.channels, " "),
                       image.encoding == Encoding::srgb ? "srgb" : "linear");
  });
  module.def(
      "read_image",
      [](const std::filesystem::path& path) {
        return interruptible([&] { return read_image(path); });
      },
      py::arg("path"),
      "Reads an .exr, .png or .hdr file with all its channels. Raises InputError.");
  add_comparison(module);
}

}  // namespace clpv::python
