// SPDX-License-Identifier: MIT
#include "device/prefix_sum.hpp"

namespace clpv {
namespace {

const ProgramSource kSource{"prefix_sum.cl"};
constexpr std::size_t kBlock = 1024;  // values of a work-group

}  // namespace

PrefixSum::PrefixSum(Session& session)
    : session_(session),
      sum_blocks_(session, kSource, "sum_blocks"),
      place_blocks_(session, kSource, "place_blocks") {}

void PrefixSum::run(const Buffer& values, std::size_t count, const Buffer& total) {
  const std::size_t group = session_.device().lanes == 1 ? 64 : 1,
                    blocks = (count + kBlock - 1) / kBlock;
  session_.reserve(totals_, blocks * sizeof(cl_uint), "sums of blocks");
  const auto number = static_cast<cl_uint>(count);
  sum_blocks_.set(values, number, totals_).launch(blocks * group, group);
  place_blocks_.set(values, number, totals_, total).launch(blocks * group, group);
}

}  // namespace clpv
