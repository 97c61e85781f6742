// SPDX-License-Identifier: MIT
// What blockers let through, by kernels and CPU reference, against closed forms.
#include "pipeline/transmittance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "reference/transmittance.hpp"
#include "tests/support/on_device.hpp"

namespace clpv::transmittance_test {
namespace {

using test::test_session;

constexpr int kGrid = 5;  // no multiple of anything: borders, partial work-groups
constexpr std::size_t kCells = std::size_t{kGrid} * kGrid * kGrid;
constexpr double kFloat = 1e-6;  // sums of N products of numbers about 1

/// A link into a cell: which of its corners block, and what their blockers are looked up by.
struct Link {
  glm::ivec3 side;
  glm::dvec3 direction;  // of the light
  std::vector<double> blocked_by;
};

/// In the order of the transmittance volume's planes.
std::vector<Link> links(const Transport& transport) {
  std::vector<Link> result;
  if (const auto* faces = std::get_if<FaceTransport>(&transport.scheme)) {
    for (const Face& face : faces->faces) result.push_back({face.normal, face.direction, face.blocked_by});
    return result;
  }
  for (const SweepLink& link : std::get<std::vector<SweepLink>>(transport.scheme))
    result.push_back({-link.offset, link.direction, link.blocked_by});
  return result;
}

/// What blocks at a corner.
using Blockers = std::function<std::vector<double>(const glm::ivec3& corner)>;

reference::Volume geometry_of(int numbers, const Blockers& blockers) {
  reference::Volume volume(kGrid + 1, numbers, 1);
  for (int z = 0; z <= kGrid; ++z) {
    for (int y = 0; y <= kGrid; ++y) {
      for (int x = 0; x <= kGrid; ++x) {
        const std::vector<double> c = blockers({x, y, z});
        for (int i = 0; i < numbers; ++i)
          volume.at(0, i, x, y, z) = static_cast<float>(c[static_cast<std::size_t>(i)]);
      }
    }
  }
  return volume;
}

std::vector<float> on_device(const Basis& basis, const Transport& transport,
                             const reference::Volume& blockers) {
  Volume geometry(test_session(), {kGrid + 1, blockers.coefficients, 1}, "test: geometry");
  geometry.write(test_session(), {blockers.values.begin(), blockers.values.end()});
  LinkTransmittance transmitter(test_session(), basis, transport, {.grid = kGrid});
  transmitter.transmit(geometry);
  return transmitter.transmittance().read(test_session());
}

/// What kernel and CPU reference let through a cell by a link has to be `expected`.
void expect_all(const Basis& basis, const Transport& transport, const reference::Volume& geometry,
                const std::function<double(const glm::ivec3& cell, const Link& link)>& expected,
                double allowed = kFloat) {
  const std::vector<float> device = on_device(basis, transport, geometry);
  const std::vector<Link> all = links(transport);
  ASSERT_EQ(device.size(), all.size() * kCells);
  for (std::size_t at = 0; at < device.size(); ++at) {
    const int cell = static_cast<int>(at % kCells);
    const glm::ivec3 p(cell % kGrid, cell / kGrid % kGrid, cell / kGrid / kGrid);
    const Link& link = all[at / kCells];
    const double through = expected(p, link);
    ASSERT_NEAR(device[at], through, allowed) << "link " << at / kCells << " cell " << cell;
    ASSERT_NEAR(reference::transmitted(geometry, p, link.side, link.blocked_by), through, allowed)
        << "expected, link " << at / kCells << " cell " << cell;
  }
}

std::vector<double> times(double s, std::vector<double> c) {
  for (double& value : c) value *= s;
  return c;
}

class EachTransport : public ::testing::TestWithParam<TransportKind> {
 protected:
  Transport transport(const Basis& basis, Blocking blocking = Blocking::one_sided) const {
    return make_transport(GetParam(), basis, {}, blocking);
  }
};
INSTANTIATE_TEST_SUITE_P(Transmit, EachTransport,
                         ::testing::Values(TransportKind::sampled, TransportKind::sweep),
                         [](const auto& info) { return std::string(name_of(info.param)); });

TEST_P(EachTransport, NothingBlocksNothing) {
  const auto basis = make_basis("srbf8v2");
  const reference::Volume nothing(kGrid + 1, basis->size(), 1);
  expect_all(
      *basis, transport(*basis), nothing, [](const glm::ivec3&, const Link&) { return 1.0; }, 0);
}

// Of sh2, whose constant is one exactly: blockers that grow from corner to corner are averaged over the side that light
// comes in by, and B is cut to [0, 1].
TEST_P(EachTransport, BlockersAreAveragedOverTheSideOfTheWay) {
  const auto basis = make_basis("sh2");
  const glm::dvec3 slope(0.21, -0.13, 0.17);
  const auto blocked = [&](const glm::dvec3& corner) { return 0.4 + glm::dot(slope, corner); };
  const reference::Volume geometry = geometry_of(basis->size(), [&](const glm::ivec3& corner) {
    return times(blocked(glm::dvec3(corner)), basis->constant());
  });
  int open = 0, shut = 0, between = 0;
  expect_all(*basis, transport(*basis), geometry, [&](const glm::ivec3& cell, const Link& link) {
    const double through = 1 - blocked(glm::dvec3(cell) + 0.5 + 0.5 * glm::dvec3(link.side));
    ++(through >= 1 ? open : through <= 0 ? shut : between);
    return std::clamp(through, 0.0, 1.0);
  });
  EXPECT_GT(open, 0);
  EXPECT_GT(shut, 0);
  EXPECT_GT(between, 0);
}

// On sh2 a surfel that faces n blocks 1/4 - n.w/2 of what travels along w.
TEST_P(EachTransport, SurfelsBlockWhatTravelsAgainstTheirNormal) {
  const auto basis = make_basis("sh2");
  const glm::dvec3 normal = glm::normalize(glm::dvec3(2, -1, 3));
  const std::vector<double> front = times(0.9, basis->clamped_cosine(normal));
  expect_all(*basis, transport(*basis), geometry_of(basis->size(), [&](const glm::ivec3&) { return front; }),
             [&](const glm::ivec3&, const Link& link) {
               return 1 - std::clamp(0.9 * (0.25 - 0.5 * glm::dot(normal, link.direction)), 0.0, 1.0);
             });
}

// A surfel across an axis keeps |n.w| of what travels along w, whatever w; a slanted one the same of what travels along
// the axes, and no less of the rest.
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
  expect_all(*basis, by_areas, surfel(up),
             [&](const glm::ivec3&, const Link& link) { return 1 - blocked(up, link.direction); });
  int along_axes = 0;
  for (const Link& link : links(by_areas)) {
    const double through = reference::transmitted(surfel(slanted), glm::ivec3(2), link.side, link.blocked_by);
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

}  // namespace
}  // namespace clpv::transmittance_test
