// SPDX-License-Identifier: MIT
// Peers: clpv beside the same work in C++.
#include "peers/peers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "peers/propagate_avx2.hpp"
#include "support/error.hpp"
#include "tests/support/bench_rows.hpp"

namespace clpv::bench::peers_test {
namespace {

using ::testing::ElementsAre;

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

}  // namespace
}  // namespace clpv::bench::peers_test
