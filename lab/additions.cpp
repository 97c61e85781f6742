// SPDX-License-Identifier: MIT
#include "additions.hpp"

#include "baselines/quality_baselines.hpp"
#include "peers/peers.hpp"
#include "search/normals.hpp"

namespace clpv {

Additions lab_additions() {
  static const std::vector<bench::Suite> suites{bench::native_suite()};
  return {std::make_shared<QualityBaselines>(), &suites, add_normals};
}

}  // namespace clpv
