// SPDX-License-Identifier: MIT
// Bases of functions on the sphere.
#include "basis/basis.hpp"

#include "basis/lobe_quality.hpp"
#include "basis/quadrature.hpp"
#include "basis/rotated_lobe.hpp"
#include "basis/transport.hpp"
#include "module.hpp"
#include "options/render_options.hpp"
#include "support/error.hpp"

namespace clpv::python {
namespace {

constexpr int kMaxSteps = 100000;  // bounds the run time of energy()

glm::dvec3 unit(const double* v) {
  const glm::dvec3 w(v[0], v[1], v[2]);
  const double length = glm::length(w);
  if (length > 0 && std::isfinite(length)) return w / length;
  throw Error(ExitCode::usage, "direction: found ({}, {}, {}), allowed: finite numbers, not all 0",
              w.x, w.y, w.z);
}

void require_length(const char* what, const DoubleArray& given, std::size_t length) {
  if (given.ndim() != 1 || given.shape(0) != static_cast<py::ssize_t>(length))
    throw Error(ExitCode::usage, "{}: found shape {}, allowed: ({},)", what, shape_text(given),
                length);
}

using Bandwidth = std::variant<double, DoubleArray>;  // of all centres, or of each

std::unique_ptr<Basis> make(const std::string& name, const std::optional<Bandwidth>& bandwidth,
                            const std::optional<DoubleArray>& centres) {
  const auto* each = bandwidth ? std::get_if<DoubleArray>(&*bandwidth) : nullptr;
  if (each && each->ndim() == 0) return make(name, Bandwidth(*each->data()), centres);
  if (each && !centres)
    throw Error(ExitCode::usage, "bandwidth: found shape {}, allowed without centres: a number",
                shape_text(*each));
  const double lambda = bandwidth && !each ? std::get<double>(*bandwidth) : kDefaultLambda;
  if (!centres) return make_basis(name, lambda);
  require_vectors(*centres, "centres");
  std::vector<glm::dvec3> all;
  for (py::ssize_t i = 0; i < centres->size() / 3; ++i)
    all.push_back(unit(centres->data() + 3 * i));
  if (!each) return make_basis_from_centres(name, all, lambda);
  require_length("bandwidth", *each, all.size());
  return make_basis_from_centres(name, all,
                                 std::vector<double>(each->data(), each->data() + each->size()));
}

/// Applies `values_at(w, out)`, which writes `count` numbers, to each direction of an array (...,
/// 3).
template <typename Values>
py::array_t<double> at_each(const char* name, const DoubleArray& given, int count,
                            const Values& values_at) {
  require_vectors(given, name);
  py::array_t<double> made(shape_with_last(given, count));
  for (py::ssize_t i = 0; i < given.size() / 3; ++i)
    values_at(unit(given.data() + 3 * i),
              std::span(made.mutable_data() + i * count, static_cast<std::size_t>(count)));
  return made;
}

py::array_t<double> vector_array(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

py::array_t<double> vector_array(const std::vector<glm::dvec3>& rows) {
  py::array_t<double> made({static_cast<py::ssize_t>(rows.size()), py::ssize_t{3}});
  std::copy(rows.begin(), rows.end(), reinterpret_cast<glm::dvec3*>(made.mutable_data()));
  return made;
}

/// (n,3): nodes of the quadrature that project() sums over.
py::array_t<double> directions(const Basis& basis) {
  std::vector<glm::dvec3> all;
  for (const QuadratureNode& node : quadrature(basis, octants())) all.push_back(node.w);
  return vector_array(all);
}

/// A^-1 Int b f dw by quadrature. Takes values, not a function: Python's exit ends daemon threads
/// that run Python code below C++.
py::array_t<double> project(const Basis& basis, const DoubleArray& values) {
  const std::vector<QuadratureNode> nodes = quadrature(basis, octants());
  require_length("values", values, nodes.size());
  const auto wrong = std::find_if_not(values.data(), values.data() + values.size(),
                                      [](double value) { return std::isfinite(value); });
  if (wrong != values.data() + values.size())
    throw Error(ExitCode::usage, "values: found {} at {}, allowed: finite numbers", *wrong,
                wrong - values.data());
  std::vector<double> moments(static_cast<std::size_t>(basis.size()));
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const std::vector<double> b = basis.evaluate(nodes[k].w);
    for (std::size_t i = 0; i < b.size(); ++i)
      moments[i] += nodes[k].weight * values.data()[k] * b[i];
  }
  return vector_array(basis.gram_inverse() * moments);
}

/// None: exact lobes; else those of the paper, by a table of that size.
LobeOptions lobe_options(const std::optional<int>& table_size) {
  if (table_size && (*table_size < 0 || *table_size > kMaxTableSize))
    throw Error(ExitCode::usage, "table_size: found {}, allowed: 0..{}", *table_size,
                kMaxTableSize);
  return table_size ? LobeOptions{.kind = LobeKind::rotate, .table_size = *table_size}
                    : LobeOptions{};
}

double energy(const Basis& basis, int steps, const std::string& transport,
              const std::optional<int>& table_size) {
  const auto kind = named<TransportKind>("transport", transport);
  if (!has_faces(kind))
    throw Error(ExitCode::usage, "transport: found '{}', allowed: sampled|exact", transport);
  if (steps < 0 || steps > kMaxSteps)
    throw Error(ExitCode::usage, "steps: found {}, allowed: 0..{}", steps, kMaxSteps);
  const Transport made = make_transport(kind, basis, lobe_options(table_size));
  return energy_after(basis, std::get<FaceTransport>(made.scheme), steps);
}

py::dict lobe(const Basis& basis, const Vec3& axis, const std::optional<DoubleArray>& given) {
  const glm::dvec3 d = unit(axis.data());
  std::vector<double> c = basis.clamped_cosine(d);
  if (given) {
    require_length("coefficients", *given, c.size());
    c.assign(given->data(), given->data() + given->size());
  }
  const LobeQuality quality = lobe_quality(basis, c, d);
  return py::dict(py::arg("relative_l2") = quality.relative_l2,
                  py::arg("minimum") = quality.minimum, py::arg("flux") = quality.flux,
                  py::arg("peak_error_degrees") = quality.peak_error_degrees);
}

}  // namespace

void add_basis(py::module_& module) {
  module.def("bases", &basis_names, "Names of all bases.");
  py::class_<Basis> type(
      module, "Basis",
      "N functions b_i on the unit sphere.\n\n"
      "bandwidth: lambda in (0, 1) of radial functions (None: 0.25), or one for each centre;\n"
      "centres: array (N, 3), for radial functions of one's own. Directions may have any length.");
  type.def(py::init(&make), py::arg("name") = "sh2", py::arg("bandwidth") = py::none(),
           py::arg("centres") = py::none());
  type.def_property_readonly("name", &Basis::name);
  type.def("__len__", &Basis::size);
  type.def_property_readonly("condition", &Basis::condition,
                             "Condition number of the Gram matrix.");
  type.def_property_readonly(
      "integrals", [](const Basis& b) { return vector_array(b.integrals()); },
      "Array (N,): integral of each function.");
  type.def_property_readonly(
      "centres", [](const Basis& b) { return vector_array(b.centres()); },
      "Array (N, 3) of unit vectors; (0, 3) without centres.");
  type.def_property_readonly(
      "bandwidths", [](const Basis& b) { return vector_array(b.lambdas()); },
      "Array (N,); (0,) without centres.");
  type.def(
      "evaluate",
      [](const Basis& basis, const DoubleArray& directions) {
        return at_each("directions", directions, basis.size(),
                       [&](const glm::dvec3& w, std::span<double> out) { basis.evaluate(w, out); });
      },
      py::arg("directions"), "b_i(w) of directions (..., 3), as an array (..., N).");
  type.def(
      "clamped_cosine",
      [](const Basis& basis, const DoubleArray& axes, const std::optional<int>& table_size) {
        const Lobes lobes(basis, lobe_options(table_size));
        return at_each("axes", axes, basis.size(), [&](const glm::dvec3& d, std::span<double> out) {
          const std::vector<double> c = lobes(d);
          std::copy(c.begin(), c.end(), out.begin());
        });
      },
      py::arg("axes"), py::arg("table_size") = py::none(),
      "Projection of max(0, w . axis) for axes (..., 3), as an array (..., N): exact, or along +z "
      "and rotated through a table of that many entries as\n"
      "in the paper (0: without a table).");
  type.def_property_readonly(
      "mean_error", [](const Basis& b) { return mean_relative_l2(b, Lobes(b, {})); },
      "Mean relative L2 error of exactly projected clamped cosines over all axes.");
  type.def("energy", &energy, py::arg("steps"), py::arg("transport") = "sampled",
           py::arg("table_size") = py::none(),
           "Energy of an isotropic source\n"
           "after `steps` steps of propagation over its initial one; transport: 'sampled' or\n"
           "'exact'; table_size as for clamped_cosine().");
  type.def("directions", &directions,
           "Array (K, 3): directions at which project() takes values of a "
           "function.");
  type.def("project", &project, py::arg("values"),
           "Array (N,): least-squares projection of a function that\n"
           "has these values at directions().");
  type.def("lobe", &lobe, py::arg("axis"), py::arg("coefficients") = py::none(),
           "Errors of a lobe (None: clamped_cosine(axis)) "
           "against the clamped\n"
           "cosine: relative_l2, minimum, flux (pi is exact), peak_error_degrees.");
}

}  // namespace clpv::python
