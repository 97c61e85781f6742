#include "pipeline/transport_source.hpp"

#include <fmt/format.h>

#include <array>

#include "pipeline/volume.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr int kCorners = 8;

std::vector<std::string> fields(const std::string& name, int count) {
  std::vector<std::string> result;
  for (int i = 0; i < count; ++i) result.push_back(fmt::format("{}.c{}", name, i));
  return result;
}

int axis_index(const glm::ivec3& axis) {
  for (int i = 0; i < 6; ++i) {
    if (kAxes[static_cast<std::size_t>(i)] == axis) return i;
  }
  return -1;
}

/// What a mirror does to six fluxes in the order of kAxes: it swaps the two of its axis.
SignedPermutation mirror_of_fluxes(int axis) {
  SignedPermutation swap{{0, 1, 2, 3, 4, 5}, {1, 1, 1, 1, 1, 1}};
  std::swap(swap.target[static_cast<std::size_t>(2 * axis)],
            swap.target[static_cast<std::size_t>(2 * axis + 1)]);
  return swap;
}

/// Mirrors of what a cell holds, x y z; and those that leave `axis` alone.
struct Mirrors {
  std::array<SignedPermutation, 3> all;
  std::vector<SignedPermutation> across(int axis) const {
    return {all[static_cast<std::size_t>((axis + 1) % 3)], all[static_cast<std::size_t>((axis + 2) % 3)]};
  }
};

Mirrors mirrors_of(const Basis& basis, State state) {
  Mirrors result;
  for (int axis = 0; axis < 3; ++axis) {
    result.all[static_cast<std::size_t>(axis)] =
        state == State::fluxes ? mirror_of_fluxes(axis) : mirror(basis, axis);
  }
  return result;
}

int axis_of(const glm::ivec3& k) {
  return k.x != 0 ? 0 : k.y != 0 ? 1 : 2;
}

/// Which of the cell's 8 corners (bit 0 x, 1 y, 2 z) lie on the side `normal` points to.
std::vector<int> corners_towards(const glm::ivec3& normal) {
  std::vector<int> result;
  for (int c = 0; c < kCorners; ++c) {
    bool on = true;
    for (int axis = 0; axis < 3; ++axis) {
      if (normal[axis] != 0) on = on && ((c >> axis) & 1) == (normal[axis] > 0 ? 1 : 0);
    }
    if (on) result.push_back(c);
  }
  return result;
}

/// Names of the mean blocker over the corners towards `normal`, one a coefficient.
std::vector<std::string> mean_blocker(LinearCode& code, const glm::ivec3& normal, int n) {
  const std::vector<int> corners = corners_towards(normal);
  std::vector<std::string> means;
  for (int i = 0; i < n; ++i) {
    std::vector<std::string> parts;
    for (const int c : corners) parts.push_back(fmt::format("g{}.c{}", c, i));
    while (parts.size() > 1) {
      std::vector<std::string> halved;
      for (std::size_t p = 0; p < parts.size(); p += 2) halved.push_back(code.add(parts[p], parts[p + 1]));
      parts = halved;
    }
    means.push_back(parts.front());  // the sum; the rows carry 1 / number of corners
  }
  return means;
}

struct Generated {
  std::string neighbours;  // body of CLPV_EACH_NEIGHBOUR
  LinearCode arrive, transmittance;
  std::vector<std::string> gains;
  std::string transmittances;  // declarations of t0, t1, ...
  std::vector<int> ways;       // which of them there are
  int count = 0;
};

/// Declares t<way> = 1 - clamp(B, 0, 1) = 1/2 + |1/2 - B/2| - |B/2| for each way, its blocker looked up in
/// its direction in the mean over the corners towards `normal`.
void transmit(Generated& out, const Basis& basis, const Mirrors& mirrors, const glm::ivec3& normal,
              const std::vector<glm::dvec3>& directions, const std::vector<int>& ways) {
  LinearCode& code = out.transmittance;
  const auto corners = static_cast<double>(corners_towards(normal).size());
  Matrix rows(static_cast<int>(directions.size()), basis.size());
  for (int r = 0; r < rows.rows(); ++r) {
    basis.evaluate(directions[static_cast<std::size_t>(r)], rows.row(r));
    for (double& value : rows.row(r)) value *= 0.5 / corners;
  }
  const int moving = (normal.x != 0) + (normal.y != 0) + (normal.z != 0);
  const auto symmetries = moving == 1 ? mirrors.across(axis_of(normal)) : std::vector<SignedPermutation>{};
  const auto halves = code.product(rows, mean_blocker(code, normal, basis.size()), symmetries);
  for (std::size_t r = 0; r < ways.size(); ++r) {
    const std::string through =
        code.name(fmt::format("0.5f + (fabs(0.5f - {0}) - fabs({0}))", halves[r]), {.additions = 3});
    out.transmittances += fmt::format("  const float t{} = {};\n", ways[r], through);
    out.ways.push_back(ways[r]);
  }
}

void add_neighbour(Generated& out, const glm::ivec3& travel) {
  out.neighbours += fmt::format(" DO({}, {}, {}, {})", out.count, -travel.x, -travel.y, -travel.z);
  ++out.count;
}

/// Fluxes of the travelling state through the 30 faces: F = flux . c, or with fluxes travelling F = (flux L)
/// . phi.
Matrix half_face_rows(const FaceTransport& faces, State source) {
  const int n = static_cast<int>(faces.faces.front().flux.size());
  Matrix rows(static_cast<int>(faces.faces.size()), n);
  for (int f = 0; f < rows.rows(); ++f) {
    for (int i = 0; i < n; ++i)
      rows(f, i) = 0.5 * faces.faces[static_cast<std::size_t>(f)].flux[static_cast<std::size_t>(i)];
  }
  return source == State::fluxes ? rows * faces.lobes : rows;
}

void generate_faces(Generated& out, const Basis& basis, const FaceTransport& faces, const StepForm& form) {
  const Matrix rows = half_face_rows(faces, form.source);
  const Mirrors mirrors = mirrors_of(basis, form.source);
  std::array<std::string, 6> through;
  through.fill("0.0f");
  for (int k = 0; k < 6; ++k) {
    const glm::ivec3 travel = kAxes[static_cast<std::size_t>(k)];
    Matrix five(5, rows.columns());
    for (int f = 0; f < 5; ++f)
      std::copy(rows.row(5 * k + f).begin(), rows.row(5 * k + f).end(), five.row(f).begin());
    const auto fluxes = out.arrive.product(five, fields(fmt::format("a{}", k), rows.columns()),
                                           mirrors.across(axis_of(travel)));
    for (int f = 0; f < 5; ++f) {
      const int way = 5 * k + f;
      const std::string& half = fluxes[static_cast<std::size_t>(f)];
      std::string flux = out.arrive.name(fmt::format("{0} + fabs({0})", half), {.additions = 1});
      std::string& sum =
          through[static_cast<std::size_t>(axis_index(faces.faces[static_cast<std::size_t>(way)].normal))];
      if (!form.blocking) {
        sum = out.arrive.add(sum, flux);
      } else if (sum == "0.0f") {
        sum = out.arrive.name(fmt::format("{} * t{}", flux, way), {.multiplications = 1});
      } else {
        sum = out.arrive.name(fmt::format("fma({}, t{}, {})", flux, way, sum), {.fused = 1});
      }
    }
    add_neighbour(out, travel);
  }
  const std::vector<std::string> received(through.begin(), through.end());
  if (form.target == State::fluxes) {
    out.gains = received;
  } else {
    out.gains = out.arrive.product(faces.lobes, received,
                                   {mirror_of_fluxes(0), mirror_of_fluxes(1), mirror_of_fluxes(2)});
  }
  if (!form.blocking) return;
  const Mirrors blocker_mirrors = mirrors_of(basis, State::coefficients);
  for (int n = 0; n < 6; ++n) {  // five ways lead to each face; its blocker is looked up against the way
    std::vector<glm::dvec3> directions;
    std::vector<int> ways;
    for (int f = 0; f < 30; ++f) {
      const Face& face = faces.faces[static_cast<std::size_t>(f)];
      if (face.normal != kAxes[static_cast<std::size_t>(n)]) continue;
      directions.push_back(-face.direction);
      ways.push_back(f);
    }
    transmit(out, basis, blocker_mirrors, kAxes[static_cast<std::size_t>(n)], directions, ways);
  }
}

/// Mirrors of all neighbours' inputs together: a mirror swaps neighbours and the functions within each.
SignedPermutation mirror_of_neighbours(const OperatorTransport& scheme, const SignedPermutation& within,
                                       int axis, int n) {
  if (!within.exists()) return {};
  SignedPermutation result;
  for (const auto& neighbour : scheme.neighbours) {
    glm::ivec3 image = neighbour.offset;
    image[axis] = -image[axis];
    int other = -1;
    for (std::size_t q = 0; q < scheme.neighbours.size(); ++q) {
      if (scheme.neighbours[q].offset == image) other = static_cast<int>(q);
    }
    if (other < 0) return {};
    for (int i = 0; i < n; ++i) {
      result.target.push_back(other * n + within.target[static_cast<std::size_t>(i)]);
      result.sign.push_back(within.sign[static_cast<std::size_t>(i)]);
    }
  }
  return result;
}

constexpr int kMostSharedInputs =
    512;  // above, rows are so sparse (direction bins) that mirrors have nothing to share

void generate_operators(Generated& out, const Basis& basis, const OperatorTransport& scheme,
                        const StepForm& form) {
  const int n = basis.size();
  const int count = static_cast<int>(scheme.neighbours.size());
  const Mirrors mirrors = mirrors_of(basis, State::coefficients);
  Matrix rows(n, n * count);
  std::vector<std::string> inputs;
  for (int k = 0; k < count; ++k) {
    const auto& neighbour = scheme.neighbours[static_cast<std::size_t>(k)];
    for (int r = 0; r < n; ++r) {
      for (int i = 0; i < n; ++i) rows(r, k * n + i) = neighbour.weights(r, i);
    }
    const bool blocked = form.blocking && neighbour.offset != glm::ivec3(0);
    for (const std::string& field : fields(fmt::format("a{}", k), n)) {
      inputs.push_back(blocked ? fmt::format("({} * t{})", field, k) : field);
    }
    if (blocked) {
      transmit(out, basis, mirrors, -neighbour.offset, {-neighbour.direction}, {k});
    }
    add_neighbour(out, neighbour.offset);
  }
  for (int r = 0; form.blocking && r < static_cast<int>(inputs.size()); ++r) {
    bool used = false;
    for (int row = 0; row < n; ++row) used = used || rows(row, r) != 0;
    if (used && inputs[static_cast<std::size_t>(r)].front() == '(') {
      inputs[static_cast<std::size_t>(r)] =
          out.arrive.name(inputs[static_cast<std::size_t>(r)], {.multiplications = 1});
    }
  }
  std::vector<SignedPermutation> symmetries;
  for (int axis = 0; axis < 3 && n * count <= kMostSharedInputs; ++axis) {
    symmetries.push_back(mirror_of_neighbours(scheme, mirrors.all[static_cast<std::size_t>(axis)], axis, n));
  }
  out.gains = out.arrive.product(rows, inputs, symmetries);
}

std::string expand_function(const Transport& transport, const Basis& basis, State target) {
  std::string text = "CLPV_INLINE Coefficients clpv_expand(const Target sum) {\n";
  if (target == State::coefficients) {
    text += "  Coefficients r;\n";
    for (int i = 0; i < basis.size(); ++i) text += fmt::format("  r.c{0} = sum.c{0};\n", i);
    return text + "  return r;\n}\n";
  }
  LinearCode code;
  const auto values = code.product(std::get<FaceTransport>(transport.scheme).lobes, fields("sum", 6),
                                   {mirror_of_fluxes(0), mirror_of_fluxes(1), mirror_of_fluxes(2)});
  text += code.text() + "  Coefficients r;\n";
  for (int i = 0; i < basis.size(); ++i)
    text += fmt::format("  r.c{} = {};\n", i, values[static_cast<std::size_t>(i)]);
  return text + "  return r;\n}\n";
}

/// `statements` as the body of a macro. Not a function: compilers that pass structs in vector registers would keep
/// work-items from being vectorised.
std::string macro(const std::string& name, const std::string& statements) {
  std::string text = "#define " + name;
  for (const char c : statements) text += c == '\n' ? std::string(" \\\n") : std::string(1, c);
  return text + "\n\n";
}

std::string macros(const Generated& out, const StepForm& form) {
  std::string text;
  if (form.blocking)
    text += macro("CLPV_TRANSMITTANCE", "\n" + out.transmittance.text() + out.transmittances);
  std::string gained = "\n" + out.arrive.text() + "  Target gained;\n";
  for (std::size_t i = 0; i < out.gains.size(); ++i)
    gained += fmt::format("  gained.c{} = {};\n", i, out.gains[i]);
  return text + macro("CLPV_ARRIVE", gained);
}

}  // namespace

TransportSource transport_source(const Basis& basis, const Transport& transport, const StepForm& form) {
  const auto* faces = std::get_if<FaceTransport>(&transport.scheme);
  if (faces == nullptr && (form.source == State::fluxes || form.target == State::fluxes)) {
    throw Error(ExitCode::usage, "--state fluxes: transport '{}' has no faces; allowed: coefficients",
                transport.name);
  }
  Generated out;
  if (faces != nullptr) {
    generate_faces(out, basis, *faces, form);
  } else {
    generate_operators(out, basis, std::get<OperatorTransport>(transport.scheme), form);
  }
  TransportSource result;
  result.source_count = form.source == State::fluxes ? 6 : basis.size();
  result.target_count = form.target == State::fluxes ? 6 : basis.size();
  result.neighbours = out.count;
  result.arrive = out.arrive.operations();
  result.transmittance = out.transmittance.operations();
  result.text = coefficient_macros(basis.size()) + cell_macros("Source", "SOURCE", result.source_count) +
                cell_macros("Target", "TARGET", result.target_count) +
                fmt::format("#define CLPV_SOURCE_N {}\n#define CLPV_TARGET_N {}\n", result.source_count,
                            result.target_count) +
                fmt::format("#define CLPV_EACH_NEIGHBOUR(DO){}\n", out.neighbours) + macros(out, form) +
                expand_function(transport, basis, form.target);
  return result;
}

}  // namespace clpv
