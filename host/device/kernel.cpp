// SPDX-License-Identifier: MIT
#include "device/kernel.hpp"

#include <algorithm>

#include "device/session.hpp"
#include "support/error.hpp"

namespace clpv {

Kernel::Kernel(Session& session, const ProgramSource& source, std::string name)
    : session_(&session), program_(session.programs().describe(source)), name_(std::move(name)) {
  program_->kernels.insert(name_);
}

bool Kernel::claimed() const {
  return session_->programs().claims(*program_);
}

cl::Kernel& Kernel::built() {
  if (kernel_() == nullptr) {
    kernel_ = session_->programs().kernel(*program_, name_);
    parameter_count_ = kernel_.getInfo<CL_KERNEL_NUM_ARGS>();
  }
  return kernel_;
}

bool Kernel::changes(std::span<const std::byte> value) {
  if (values_.size() <= argument_count_) values_.resize(argument_count_ + 1);
  std::vector<std::byte>& last = values_[argument_count_];
  if (std::ranges::equal(last, value)) return false;
  last.assign(value.begin(), value.end());
  return true;
}

HostWork& Kernel::host() const {
  return session_->timeline().host();
}

void Kernel::record(const cl::Memory& memory) {
  if (Recorder* recorder = session_->recorder())
    recorder->set_argument(kernel_, argument_count_, memory);
}

void Kernel::record(std::span<const std::byte> value) {
  if (Recorder* recorder = session_->recorder())
    recorder->set_argument(kernel_, argument_count_, value);
}

void Kernel::launch(const cl::NDRange& global, const cl::NDRange& local, Chain chain) {
  if (!claimed()) return;
  if (argument_count_ != parameter_count_) {
    throw Error(ExitCode::run_time, "kernel '{}' was given {} of its {} arguments", name_,
                argument_count_, parameter_count_);
  }
  session_->launch(built(), global, local, chain);
  session_->programs().finish_first_launch(*program_, name_, [this] { session_->finish(); });
}

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
