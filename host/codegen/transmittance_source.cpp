// SPDX-License-Identifier: MIT
#include "codegen/transmittance_source.hpp"

#include <fmt/format.h>

#include <optional>

#include "codegen/linear_code.hpp"

namespace clpv {
namespace {

constexpr int kCorners = 8;

struct TransmittanceCode {
  LinearCode code;
  std::string assignments;  // to links.c0, links.c1, ...
};

/// Numbers of the cell's corners (bit 0 x, 1 y, 2 z) on the side that `normal` points to.
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

/// Names of the sums over the corners towards `normal`, one for each of their numbers that `rows` use.
std::vector<std::string> blockers_towards(LinearCode& code, const glm::ivec3& normal, const Matrix& rows) {
  const std::vector<int> corners = corners_towards(normal);
  std::vector<std::string> sums;
  for (int i = 0; i < rows.columns(); ++i) {
    bool used = false;
    for (int r = 0; r < rows.rows(); ++r) used = used || rows(r, i) != 0;
    if (!used) {
      sums.push_back("0.0f");
      continue;
    }
    std::vector<std::string> parts;
    for (const int c : corners) parts.push_back(fmt::format("g{}.c{}", c, i));
    while (parts.size() > 1) {
      std::vector<std::string> halved;
      for (std::size_t p = 0; p < parts.size(); p += 2) halved.push_back(code.add(parts[p], parts[p + 1]));
      parts = halved;
    }
    sums.push_back(parts.front());  // rows carry 1 / number of corners
  }
  return sums;
}

/// Assigns links.c<link> = 1 - clamp(B, 0, 1) = 1/2 + |1/2 - B/2| - |B/2| for each link. B is a row of `weights`
/// times the mean over the corners towards `normal`.
void add_links(TransmittanceCode& out, const std::optional<Mirrors>& mirrors, const glm::ivec3& normal,
               const std::vector<std::vector<double>>& weights, const std::vector<int>& links) {
  LinearCode& code = out.code;
  const double corners = corners_towards(normal).size();
  Matrix rows(static_cast<int>(weights.size()), static_cast<int>(weights.front().size()));
  for (int r = 0; r < rows.rows(); ++r) {
    for (int i = 0; i < rows.columns(); ++i) rows(r, i) = weights[r][i] * (0.5 / corners);
  }
  const int moving = (normal.x != 0) + (normal.y != 0) + (normal.z != 0);
  const auto symmetries =
      mirrors && moving == 1 ? mirrors->across(axis_of(normal)) : std::vector<SignedPermutation>{};
  const auto halves = code.product(rows, blockers_towards(code, normal, rows), symmetries);
  for (std::size_t r = 0; r < links.size(); ++r) {
    const std::string through =
        code.name(fmt::format("0.5f + (fabs(0.5f - {0}) - fabs({0}))", halves[r]), {.additions = 3});
    out.assignments += fmt::format("  links.c{} = {};\n", links[r], through);
  }
}

/// The 30 links to faces; the five links to a face share its corners.
int add_faces(TransmittanceCode& out, const std::optional<Mirrors>& mirrors, const FaceTransport& scheme) {
  for (const glm::ivec3& normal : kAxes) {
    std::vector<std::vector<double>> weights;
    std::vector<int> links;
    for (std::size_t f = 0; f < scheme.faces.size(); ++f) {
      if (scheme.faces[f].normal != normal) continue;
      weights.push_back(scheme.faces[f].blocked_by);
      links.push_back(static_cast<int>(f));
    }
    add_links(out, mirrors, normal, weights, links);
  }
  return scheme.faces.size();
}

/// One link per neighbour, through the face, edge or corner that the two cells share.
int add_neighbours(TransmittanceCode& out, const std::optional<Mirrors>& mirrors,
                   const std::vector<SweepLink>& links) {
  int number = 0;
  for (const SweepLink& link : links) add_links(out, mirrors, -link.offset, {link.blocked_by}, {number++});
  return number;
}

}  // namespace

TransmittanceSource transmittance_source(const Basis& basis, const Transport& transport) {
  TransmittanceCode out;
  TransmittanceSource result;
  // Each link uses one to three areas: no products for mirrors to share.
  std::optional<Mirrors> mirrors;
  if (blocks_by_lobes(transport.blocking)) mirrors = mirrors_of(basis);
  const auto* faces = std::get_if<FaceTransport>(&transport.scheme);
  result.links = faces != nullptr
                     ? add_faces(out, mirrors, *faces)
                     : add_neighbours(out, mirrors, std::get<std::vector<SweepLink>>(transport.scheme));
  result.operations = out.code.operations();
  result.text =
      coefficient_macros(blocking_size(transport.blocking, basis)) + link_macros(result.links) +
      macro_text("CLPV_TRANSMITTANCE", "\n" + out.code.text() + "  Links links;\n" + out.assignments);
  return result;
}

std::string link_macros(int links) {
  return fmt::format("#define CLPV_LINKS {}\n", links) + cell_macros("Links", "LINK", links);
}

}  // namespace clpv
