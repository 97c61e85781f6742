// SPDX-License-Identifier: MIT
// Propagation: the CPU reference against closed forms.

#include "reference/propagate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

#include "basis/transport.hpp"
#include "reference/transmittance.hpp"
#include "tests/support/numbers.hpp"

namespace clpv::propagate_test {

reference::Volume one_source(const Basis& basis, int n, const std::vector<double>& c,
                             glm::ivec3 at) {
  reference::Volume volume(n, basis.size());
  for (int channel = 0; channel < 3; ++channel) {
    for (int i = 0; i < basis.size(); ++i)
      volume.at(channel, i, at.x, at.y, at.z) = c[static_cast<std::size_t>(i)];
  }
  return volume;
}

std::vector<double> isotropic(const Basis& basis) {
  return test::times(0.25 / std::numbers::pi, basis.constant());
}

/// Energy before the first step and after each, red channel, by the CPU reference.
std::vector<double> energies(const Basis& basis, TransportKind kind, reference::Volume light,
                             int steps) {
  const Transport transport = make_transport(kind, basis);
  std::vector<double> all{reference::energy(basis, light)[0]};
  for (int step = 0; step < steps; ++step) {
    light = reference::propagate_step(transport, light, nullptr);
    all.push_back(reference::energy(basis, light)[0]);
  }
  return all;
}

TEST(Propagate, IsotropicSourceKeepsItsEnergy) {
  const auto basis = make_basis("sh2");
  for (const TransportKind kind : {TransportKind::sampled, TransportKind::exact}) {
    for (const double e :
         energies(*basis, kind, one_source(*basis, 19, isotropic(*basis), {9, 9, 9}), 8))
      EXPECT_NEAR(e, 1.0, 1e-5) << name_of(kind);
  }
}

TEST(Propagate, AxisLobeGainsByClampingOnceAndKeepsIt) {
  const auto basis = make_basis("sh2");
  const auto lobe = test::times(1 / std::numbers::pi, basis->clamped_cosine({0, 0, 1}));
  const auto light = one_source(*basis, 19, lobe, {9, 9, 9});
  const auto sampled = energies(*basis, TransportKind::sampled, light, 8);
  EXPECT_NEAR(sampled[1] / sampled[0], 1.1382, 1e-4);
  EXPECT_NEAR(sampled[8] / sampled[0], 1.1382, 1e-4);
  const auto exact = energies(*basis, TransportKind::exact, light, 1);
  EXPECT_NEAR(exact[1] / exact[0], 1.115, 1e-3);
}

// A grid's cells get what they get in a larger one.
TEST(Propagate, OnlyLightThatLeavesTheGridIsLost) {
  const auto basis = make_basis("sh2");
  const Transport transport = make_transport(TransportKind::sampled, *basis);
  const auto light = isotropic(*basis);
  const reference::Volume next = reference::propagate_step(
                              transport, one_source(*basis, 3, light, {0, 1, 1}), nullptr),
                          all = reference::propagate_step(
                              transport, one_source(*basis, 5, light, {1, 2, 2}), nullptr);
  reference::for_each_cell(
      3, [&](const glm::ivec3& p) { EXPECT_EQ(next.cell(0, p), all.cell(0, p + 1)); });
  EXPECT_LT(reference::energy(*basis, next)[0], reference::energy(*basis, all)[0] - 0.1);
}

// Transmittance past blockers against closed forms, by the CPU reference.

using test::times;

constexpr int kGrid = 5;
constexpr double kFloat = 1e-6;

/// A link into a cell: its side, the direction of the light and the weights of the blockers.
struct Link {
  glm::ivec3 side;
  glm::dvec3 direction;  // direction of the light
  std::vector<double> blocked_by;
};

/// In the order of the transmittance volume's planes.
std::vector<Link> links(const Transport& transport) {
  std::vector<Link> result;
  if (const auto* faces = std::get_if<FaceTransport>(&transport.scheme)) {
    for (const Face& face : faces->faces)
      result.push_back({face.normal, face.direction, face.blocked_by});
    return result;
  }
  for (const SweepLink& link : std::get<std::vector<SweepLink>>(transport.scheme))
    result.push_back({-link.offset, link.direction, link.blocked_by});
  return result;
}

/// Coefficients of the blockers at a corner.
using Blockers = std::function<std::vector<double>(const glm::ivec3& corner)>;

reference::Volume geometry_of(int numbers, const Blockers& blockers) {
  reference::Volume volume(kGrid + 1, numbers, 1);
  reference::for_each_cell(kGrid + 1, [&](const glm::ivec3& p) {
    const std::vector<double> c = blockers(p);
    for (int i = 0; i < numbers; ++i)
      volume.at(0, i, p.x, p.y, p.z) = c[static_cast<std::size_t>(i)];
  });
  return volume;
}

/// Expects each cell to transmit `expected` along each link.
void expect_all(const Transport& transport, const reference::Volume& geometry,
                const std::function<double(const glm::ivec3& cell, const Link& link)>& expected,
                double allowed = kFloat) {
  for (const Link& link : links(transport)) {
    reference::for_each_cell(kGrid, [&](const glm::ivec3& cell) {
      ASSERT_NEAR(reference::transmittance(geometry, cell, link.side, link.blocked_by),
                  expected(cell, link), allowed)
          << "link to " << link.side.x << link.side.y << link.side.z << " of cell " << cell.x
          << cell.y << cell.z;
    });
  }
}

struct EachTransport : ::testing::TestWithParam<TransportKind> {
  Transport transport(const Basis& basis, Blocking blocking = Blocking::one_sided) const {
    return make_transport(GetParam(), basis, {}, blocking);
  }
};
INSTANTIATE_TEST_SUITE_P(Transmit, EachTransport,
                         ::testing::Values(TransportKind::sampled, TransportKind::sweep),
                         [](const auto& info) { return std::string(name_of(info.param)); });

// In sh2, whose constant is exactly 1: blockers that grow from corner to corner are averaged over
// the side that light enters by, and B is clamped to [0, 1].
TEST_P(EachTransport, BlockersAreAveragedOverTheLinksFace) {
  const auto basis = make_basis("sh2");
  const glm::dvec3 slope(0.21, -0.13, 0.17);
  const auto blocked = [&](const glm::dvec3& corner) { return 0.4 + glm::dot(slope, corner); };
  const reference::Volume geometry = geometry_of(basis->size(), [&](const glm::ivec3& corner) {
    return times(blocked(glm::dvec3(corner)), basis->constant());
  });
  int open = 0, shut = 0, between = 0;
  expect_all(transport(*basis), geometry, [&](const glm::ivec3& cell, const Link& link) {
    const double through = 1 - blocked(glm::dvec3(cell) + 0.5 + 0.5 * glm::dvec3(link.side));
    ++(through >= 1 ? open : through <= 0 ? shut : between);
    return std::clamp(through, 0.0, 1.0);
  });
  EXPECT_GT(open, 0);
  EXPECT_GT(shut, 0);
  EXPECT_GT(between, 0);
}

// On sh2 a surfel of normal n blocks 1/4 - n.w/2 of the light along w.
TEST_P(EachTransport, SurfelsBlockWhatTravelsAgainstTheirNormal) {
  const auto basis = make_basis("sh2");
  const glm::dvec3 normal = glm::normalize(glm::dvec3(2, -1, 3));
  const std::vector<double> front = times(0.9, basis->clamped_cosine(normal));
  expect_all(
      transport(*basis), geometry_of(basis->size(), [&](const glm::ivec3&) { return front; }),
      [&](const glm::ivec3&, const Link& link) {
        return 1 - std::clamp(0.9 * (0.25 - 0.5 * glm::dot(normal, link.direction)), 0.0, 1.0);
      });
}

// A surfel across an axis blocks |n.w| of the light along every w. An oblique surfel transmits the
// same fraction along the axes, and at least that elsewhere.
TEST_P(EachTransport, AreasBlockTheirShareOfEachFace) {
  const auto basis = make_basis("sh2");
  const Transport by_areas = transport(*basis, Blocking::areas);
  const auto surfel = [](const glm::dvec3& n) {
    return geometry_of(3, [n](const glm::ivec3&) {
      return times(0.6, {std::abs(n.x), std::abs(n.y), std::abs(n.z)});
    });
  };
  const auto blocked = [](const glm::dvec3& n, const glm::dvec3& w) {
    return 0.6 * std::abs(glm::dot(n, w));
  };
  const glm::dvec3 up(0, 1, 0), slanted = glm::normalize(glm::dvec3(2, -1, 3));
  expect_all(by_areas, surfel(up),
             [&](const glm::ivec3&, const Link& link) { return 1 - blocked(up, link.direction); });
  int along_axes = 0;
  for (const Link& link : links(by_areas)) {
    const double through =
        reference::transmittance(surfel(slanted), glm::ivec3(2), link.side, link.blocked_by);
    const bool along = std::max({std::abs(link.direction.x), std::abs(link.direction.y),
                                 std::abs(link.direction.z)}) > 1 - 1e-12;
    along_axes += along;
    if (along) {
      EXPECT_NEAR(through, 1 - blocked(slanted, link.direction), kFloat);
    } else {
      EXPECT_LE(through, 1 - blocked(slanted, link.direction) + kFloat);
    }
  }
  EXPECT_EQ(along_axes, 6);
}

/// Transmittance of a link into a cell of 3^3, the middle one. `hidden`: centres that a point of a
/// cube does not see, by its column and row.
double seen_share(const std::function<int(int, int)>& hidden, const glm::ivec3& side,
                  int cell = 1) {
  constexpr int kCells = 3;
  std::vector<std::uint8_t> occluded(std::size_t{64} * kCells * kCells * kCells);
  for (int i = 0; i < static_cast<int>(occluded.size()); ++i)
    occluded[i] = static_cast<std::uint8_t>(hidden(i % 4, i / 4 % 4));
  return reference::seen_share(occluded, kCells, glm::ivec3(cell), side);
}

TEST(Transmittance, LinksTransmitTheShareOfPointsThatSeeBothEnds) {
  constexpr int kOdd = 0xaa, kEven = 0x55;  // centres at the upper and at the lower end along x
  const auto none = [](int, int) { return 0; };
  const auto all = [](int, int) { return 0xff; };
  const auto wall = [](int column, int) { return column < 2 ? kOdd : kEven; };
  const auto half = [&](int column, int row) { return row < 2 ? wall(column, row) : 0; };
  const auto on_one_side = [](int column, int) { return column < 2 ? kOdd : 0; };
  for (const glm::ivec3 side : {glm::ivec3(1, 0, 0), {-1, 1, 0}, {1, 1, -1}}) {
    EXPECT_EQ(seen_share(none, side), 1);
    EXPECT_EQ(seen_share(wall, side), 0);
    EXPECT_EQ(seen_share(half, side), 0.5);
    EXPECT_EQ(seen_share(on_one_side, side), 0.5);
    EXPECT_EQ(seen_share(all, side), 0) << "enclosed centres";
  }
  EXPECT_EQ(seen_share(wall, {0, 1, -1}), 1) << "along the wall";
  EXPECT_EQ(seen_share(wall, {1, -1, 0}, 0), 0) << "across the wall, from outside the grid";
  EXPECT_EQ(seen_share(wall, {-1, 0, 0}, 0), 1) << "from outside the grid";
}

}  // namespace clpv::propagate_test
