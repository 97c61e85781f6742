// SPDX-License-Identifier: MIT
#include "codegen/transport_source.hpp"

#include <fmt/format.h>

#include <array>

#include "codegen/linear_code.hpp"

namespace clpv {
namespace {

int axis_index(const glm::ivec3& axis) {
  for (int i = 0; i < 6; ++i) {
    if (kAxes[i] == axis) return i;
  }
  return -1;
}

struct TransportCode {
  std::string neighbours;  // body of CLPV_EACH_NEIGHBOUR
  LinearCode arrive;
  std::vector<std::string> gains;
  int count = 0;       // neighbours
  bool apart = false;  // gains are the fluxes through each face, before their lobes
};

void add_neighbour(TransportCode& out, const glm::ivec3& travel) {
  out.neighbours += fmt::format(" DO({}, {}, {}, {})", out.count, -travel.x, -travel.y, -travel.z);
  ++out.count;
}

// max(x, 0) is x/2 + |x/2|, with the halves in the constants. Comparisons would trigger LLVM's SLP vectoriser, which
// prevents vectorisation of work-items on CPUs.

/// Half the fluxes of the source state through the 30 faces: F = flux . c, or of source fluxes F = (flux L) . phi.
Matrix half_face_rows(const FaceTransport& faces, State source) {
  const int n = faces.faces.front().flux.size();
  Matrix rows(static_cast<int>(faces.faces.size()), n);
  for (int f = 0; f < rows.rows(); ++f) {
    for (int i = 0; i < n; ++i) rows(f, i) = 0.5 * faces.faces[f].flux[i];
  }
  return source == State::fluxes ? rows * faces.lobes : rows;
}

void generate_faces(TransportCode& out, const Basis& basis, const FaceTransport& faces,
                    const StepForm& form) {
  const Matrix rows = half_face_rows(faces, form.source);
  const Mirrors mirrors = form.source == State::fluxes ? mirrors_of_fluxes() : mirrors_of(basis);
  std::array<std::string, 6> through;
  through.fill("0.0f");
  for (int k = 0; k < 6; ++k) {
    const glm::ivec3 travel = kAxes[k];
    Matrix five(5, rows.columns());
    for (int f = 0; f < 5; ++f)
      std::copy(rows.row(5 * k + f).begin(), rows.row(5 * k + f).end(), five.row(f).begin());
    const auto fluxes = form.functions_at_run_time
                            ? std::vector<std::string>(5)
                            : out.arrive.product(five, fields(fmt::format("a{}", k), rows.columns()),
                                                 mirrors.across(axis_of(travel)));
    for (int f = 0; f < 5; ++f) {
      const int link = 5 * k + f;
      const std::string& half = fluxes[f];
      std::string flux =
          out.arrive.name(form.functions_at_run_time ? fmt::format("flux_through(a{}, at[{}])", k, link)
                                                     : fmt::format("{0} + fabs({0})", half),
                          {.additions = 1});
      if (form.lobes_at_run_time) {
        if (form.blocking)
          flux = out.arrive.name(fmt::format("{} * t.c{}", flux, link), {.multiplications = 1});
        out.gains.push_back(flux);
        continue;
      }
      std::string& sum = through[axis_index(faces.faces[link].normal)];
      if (!form.blocking) {
        sum = out.arrive.add(sum, flux);
      } else if (sum == "0.0f") {
        sum = out.arrive.name(fmt::format("{} * t.c{}", flux, link), {.multiplications = 1});
      } else {
        sum = out.arrive.name(fmt::format("fma({}, t.c{}, {})", flux, link, sum), {.fused = 1});
      }
    }
    add_neighbour(out, travel);
  }
  if (form.lobes_at_run_time) {
    out.apart = true;
    return;
  }
  const std::vector<std::string> received(through.begin(), through.end());
  if (form.target == State::fluxes) {
    out.gains = received;
  } else {
    out.gains = out.arrive.product(faces.lobes, received, mirrors_of_fluxes().list());
  }
}

std::string expand_function(const FaceTransport& faces, const Basis& basis, State target) {
  if (target == State::coefficients) {
    std::string text = "CLPV_INLINE Coefficients expand_fluxes(const Target a) {\n  Coefficients r;\n";
    for (int i = 0; i < basis.size(); ++i) text += fmt::format("  r.c{0} = a.c{0};\n", i);
    return text + "  return r;\n}\n";
  }
  return LinearCode().function("Coefficients", "expand_fluxes", "Target", faces.lobes,
                               mirrors_of_fluxes().list());
}

std::string arrive_macro(const TransportCode& out) {
  std::string gained = "\n" + out.arrive.text() + (out.apart ? "" : "  Target gained;\n");
  for (std::size_t i = 0; i < out.gains.size(); ++i)
    gained += fmt::format("  {}{}{} = {};\n", out.apart ? "through[" : "gained.c", i, out.apart ? "]" : "",
                          out.gains[i]);
  return macro_text("CLPV_ARRIVE", gained);
}

}  // namespace

TransportSource transport_source(const Basis& basis, const Transport& transport, const StepForm& form) {
  const auto& faces = std::get<FaceTransport>(transport.scheme);
  TransportCode out;
  generate_faces(out, basis, faces, form);
  TransportSource result;
  result.source_count = form.source == State::fluxes ? 6 : basis.size();
  result.target_count = form.target == State::fluxes ? 6 : basis.size();
  result.neighbours = out.count;
  result.arrive = out.arrive.operations();
  result.text = coefficient_macros(basis.size()) + cell_macros("Source", "SOURCE", result.source_count) +
                cell_macros("Target", "TARGET", result.target_count) +
                fmt::format("#define CLPV_SOURCE_N {}\n#define CLPV_TARGET_N {}\n", result.source_count,
                            result.target_count) +
                fmt::format("#define CLPV_EACH_NEIGHBOUR(DO){}\n", out.neighbours) + arrive_macro(out) +
                expand_function(faces, basis, form.target);
  return result;
}

}  // namespace clpv
