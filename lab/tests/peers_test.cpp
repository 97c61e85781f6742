// SPDX-License-Identifier: MIT
// Peers: clpv beside the same work in C++ and by OpenGL.
#include "peers/peers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "peers/propagate_avx2.hpp"
#include "peers/rasterize_gl.hpp"
#include "support/error.hpp"
#include "tests/support/bench_rows.hpp"

namespace clpv::bench::peers_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Peers, NativeComparesWithCodeByHand) {
  if (!avx2_supported()) GTEST_SKIP() << "no AVX2";
  const auto sh2 = make_basis("sh2");
  EXPECT_THROW(PropagateAvx2(*sh2, make_transport(TransportKind::sampled, *sh2), 12), Error);
  const std::vector<Row> rows = rows_of(native_suite(), "occlusion");
  expect_right(rows);
  EXPECT_THAT(names_of(rows),
              ElementsAre("propagate/sh2/soa/float/occlusion", "native/sh2/soa/float/occlusion"));
  EXPECT_THAT(native_suite().table(rows),
              ::testing::ContainsRegex(
                  "propagate/sh2/soa/float/occlusion .*[0-9]+[.][0-9]+ +[0-9.]+ +[0-9.e-]+\n"));
}

TEST(Peers, OpenGlDrawsTheSame) {
  const Suite suite = rasterize_suite({"opengl", rasterize_gl_job});
  const std::vector<Row> rows = rows_of(suite, "");
  ASSERT_EQ(rows.size(), 6u);
  const std::string missing = gl_missing();
  for (const Row& row : rows) {
    const bool peer = row.name.ends_with("/opengl"), there = !peer || missing.empty();
    EXPECT_EQ(row.status, there ? Status::ok : Status::unsupported)
        << row.name << ": " << row.reason;
    if (!there) {
      EXPECT_EQ(row.reason, missing);
      continue;
    }
    EXPECT_GT(row.wall_ms, 0) << row.name;
    const bool shadow = row.stage == name_of(Pass::rasterize_shadow),
               rsm = row.stage == name_of(Pass::rasterize_rsm);
    EXPECT_EQ(row.max_rel_error.has_value(), !peer || !shadow) << row.name;
    EXPECT_EQ(row.cost.pixels, shadow ? 128 * 128 : rsm ? 3 * 64 * 64 : 96 * 54);
    EXPECT_GT(row.cost.triangles, rsm ? 30000 : 10000);
  }
  const std::string table = suite.table(rows);
  EXPECT_THAT(table, HasSubstr("ns/triangle"));
  EXPECT_THAT(table, Not(HasSubstr("WRONG")));
}

}  // namespace
}  // namespace clpv::bench::peers_test
