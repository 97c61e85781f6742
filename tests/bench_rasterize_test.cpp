// SPDX-License-Identifier: MIT
// `clpv bench rasterize`: each pass is right by rays, and its peer draws the same where there is one.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "bench/baseline/rasterize_gl.hpp"
#include "bench/suites.hpp"
#include "pipeline/view.hpp"
#include "tests/support/on_device.hpp"

namespace clpv::bench::bench_rasterize_test {
namespace {

std::vector<Row> rows_of_a_hall() {
  SuiteOptions options;
  options.settings.width = 96, options.settings.height = 54;
  options.settings.rsm_size = 64, options.settings.shadow_size = 128;
  const std::vector<Group> groups = rasterize_suite().groups(test::test_session(), options);
  return run_cases(test::test_session(), groups.front().cases(), {.repetitions = 1});
}

TEST(BenchRasterize, EveryPassIsRightAndThePeerDrawsTheSame) {
  const std::vector<Row> rows = rows_of_a_hall();
  ASSERT_EQ(rows.size(), 6u);
  const std::string missing = gl_missing();
  for (const Row& row : rows) {
    const bool peer = row.name.ends_with("/opengl"), there = !peer || missing.empty();
    EXPECT_EQ(row.status, there ? Status::ok : Status::unsupported) << row.name << ": " << row.reason;
    if (!there) {
      EXPECT_EQ(row.reason, missing);
      continue;
    }
    EXPECT_GT(row.wall_ms, 0) << row.name;
    const bool depth_told = !peer || row.stage != name_of(Pass::rasterize_shadow);
    EXPECT_EQ(row.max_rel_error.has_value(), depth_told) << row.name;
    const double views = row.stage == name_of(Pass::rasterize_rsm) ? 3 : 1;
    EXPECT_EQ(row.cost.pixels, row.stage == name_of(Pass::rasterize_camera)   ? 96 * 54
                               : row.stage == name_of(Pass::rasterize_shadow) ? 128 * 128
                                                                              : views * 64 * 64);
    EXPECT_GT(row.cost.triangles, 10000 * views);
  }
  const std::string table = rasterize_suite().table(rows);
  EXPECT_NE(table.find("ns/triangle"), std::string::npos);
  EXPECT_EQ(table.find("WRONG"), std::string::npos) << table;
}

TEST(BenchRasterize, ThePeerIsThere) {
  if (const std::string missing = gl_missing(); !missing.empty()) GTEST_SKIP() << missing;
  const auto hall = scene_of({});
  const Camera camera = hall->camera({});
  GlRasterizer gl(*hall, Pass::rasterize_camera, {camera_view(camera, 32, 16)}, {});
  gl.draw();
  const auto depths = gl.depths();
  ASSERT_EQ(depths.size(), 1u);
  EXPECT_EQ(depths[0].size(), 32u * 16u);
  EXPECT_GT(*std::ranges::max_element(depths[0]), 1);
}

}  // namespace
}  // namespace clpv::bench::bench_rasterize_test
