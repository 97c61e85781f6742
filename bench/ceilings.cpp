// SPDX-License-Identifier: MIT
#include "bench/ceilings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "bench/suites.hpp"
#include "device/kernel.hpp"
#include "support/error.hpp"
#include "verify/comparison.hpp"

namespace clpv::bench {
namespace {

constexpr double kLeastMs = 2;  // a sample lasts about so long: far above a clock's tick and a launch
constexpr cl_uint kMostPasses = 1u << 22;   // results stay whole numbers that a float holds
constexpr int kChains = 12, kUnrolled = 4;  // as kernels/ceilings.cl has them
constexpr std::size_t kWidestItems =
    256;  // work-items a compute unit of a device that is not a CPU needs at least

/// How many work-items keep the device busy.
struct Shares {
  std::size_t items, local;
};

/// Of a stream: on a CPU one a core, so that what a core goes over again and again is its share of the working set.
Shares stream_shares(const Device& device) {
  if (device.type == "cpu") return {device.compute_units, 1};
  constexpr std::size_t kLocal = 64;
  return {device.compute_units * kWidestItems * 8, kLocal};
}

/// Of arithmetic: vectors are in the kernel's types, so a CPU's cores run one work-item at a time; many of them, to
/// share cores out evenly.
Shares fma_shares(const Device& device) {
  constexpr std::size_t kPerCore = 128;
  if (device.type == "cpu") return {device.compute_units * kPerCore, 1};
  return stream_shares(device);
}

/// Passes that make `launch(passes)` last kLeastMs.
template <typename Launch>
cl_uint calibrated_passes(Session& session, Launch launch) {
  cl_uint passes = 1;
  launch(passes);
  session.queue().finish();
  while (passes < kMostPasses) {
    const auto start = std::chrono::steady_clock::now();
    launch(passes);
    session.queue().finish();
    const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - start;
    if (ms.count() >= kLeastMs) break;
    passes *= 2;
  }
  return passes;
}

Case ceiling_case(const std::string& what, std::function<Job()> make) {
  Case result;
  result.row.suite = "ceilings";
  result.row.stage = "ceiling";
  result.row.name = "ceiling/" + what;
  result.make = std::move(make);
  return result;
}

Deviation exactly(const std::vector<float>& found, double wanted) {
  reference::WorstError worst;
  for (std::size_t i = 0; i < found.size(); ++i) worst.take(std::abs(found[i] - wanted) / wanted, i);
  if (worst.value == 0) return {0, 0, {}};
  return {worst.value, 0, fmt::format("value {}: {}, expected {}", worst.at, found[worst.at], wanted)};
}

Job fma_job(Session& session, int width) {
  constexpr double kStart = 3;
  constexpr int kLeastPasses = 32;  // 128 halvings: a float has come to 2 from any start
  const Shares shares = fma_shares(session.device());
  const ProgramSource source{"ceilings.cl", Literals().integer("CLPV_WIDTH", width), {}};
  auto kernel = std::make_shared<Kernel>(session, source, "fma_peak");
  const Buffer out = session.buffer(shares.items * sizeof(float), "ceilings, results");
  const auto launch = [kernel, out, shares](cl_uint passes) {
    kernel->set(passes, static_cast<cl_float>(kStart), out).launch(shares.items, shares.local);
  };
  const cl_uint passes = std::max<cl_uint>(kLeastPasses, calibrated_passes(session, launch));
  Job job;
  job.run = [launch, passes] { launch(passes); };
  job.verify = [&session, out, shares] {
    return exactly(session.read<float>(out, shares.items), 2.0 * kChains);
  };
  job.cost.flops = 2.0 * kChains * kUnrolled * width * passes * static_cast<double>(shares.items);
  return job;
}

Job stream_job(Session& session, std::size_t bytes) {
  constexpr std::size_t kWidth = 16;
  const Shares shares = stream_shares(session.device());
  const std::size_t per_item = std::max<std::size_t>(1, bytes / 3 / (kWidth * sizeof(float)) / shares.items),
                    vectors = per_item * shares.items, values = vectors * kWidth;
  const std::size_t block = session.device().type == "cpu" ? per_item : 1;
  const ProgramSource source{
      "ceilings.cl", Literals().integer("CLPV_WIDTH", kWidth).number("CLPV_BLOCK", block), {}};
  auto kernel = std::make_shared<Kernel>(session, source, "stream");
  const Buffer a = session.upload(std::vector<float>(values, 1.0f), "ceilings, stream"),
               b = session.upload(std::vector<float>(values, 2.0f), "ceilings, stream"),
               c = session.buffer(values * sizeof(float), "ceilings, stream");
  const auto launch = [=](cl_uint passes) {
    kernel->set(passes, static_cast<cl_uint>(per_item / block), a, b, c).launch(shares.items, shares.local);
  };
  const cl_uint passes = calibrated_passes(session, launch);
  Job job;
  job.reset = [&session, c, values] { session.fill_zero(c, values * sizeof(float)); };
  job.run = [launch, passes] { launch(passes); };
  job.verify = [&session, c, values, passes] {
    return exactly(session.read<float>(c, values), 1.0 + 2.0 * passes);
  };
  job.cost.working_set = 3.0 * static_cast<double>(values) * sizeof(float);
  job.cost.bytes = job.cost.working_set * passes;
  return job;
}

Job launch_job(Session& session) {
  auto kernel = std::make_shared<Kernel>(session, ProgramSource{"ceilings.cl", {}, {}}, "nothing");
  const Buffer out = session.buffer(sizeof(float), "ceilings, launch");
  Job job;
  job.reset = [&session, out] { session.fill_zero(out, sizeof(float)); };
  job.run = [kernel, out] { kernel->set(out).launch(1, 1); };
  job.verify = [&session, out] { return exactly(session.read<float>(out, 1), 1.0); };
  return job;
}

}  // namespace

std::vector<Case> ceiling_cases(Session& session) {
  std::vector<Case> cases;
  for (const int width : {4, 8, 16}) {
    cases.push_back(
        ceiling_case(fmt::format("fma/{}", width), [&session, width] { return fma_job(session, width); }));
  }
  // In KiB: from what one core's cache holds to what only memory does.
  for (const std::size_t kib : {128u, 512u, 2048u, 8192u, 32768u, 262144u}) {
    const std::string size = kib < 1024 ? fmt::format("{}KiB", kib) : fmt::format("{}MiB", kib / 1024);
    cases.push_back(ceiling_case("stream/" + size, [&session, kib] {
      return stream_job(session, std::min(kib << 10, session.largest_buffer() / 2));
    }));
  }
  cases.push_back(ceiling_case("launch", [&session] { return launch_job(session); }));
  return cases;
}

Suite ceilings_suite() {
  return {"ceilings",
          "multiply-adds, bandwidth and launches of this device at most",
          [](Session& session, const SuiteOptions&) {
            return std::vector<Group>{{[&session] { return ceiling_cases(session); }}};
          },
          {}};
}

double Ceilings::gbps(double bytes) const {
  for (const Bandwidth& bandwidth : bandwidths) {
    if (bandwidth.working_set >= bytes) return bandwidth.gbps;
  }
  return bandwidths.empty() ? 0 : bandwidths.back().gbps;
}

Ceilings ceilings_of(const std::vector<Row>& rows) {
  Ceilings ceilings;
  for (const Row& row : rows) {
    if (row.status != Status::ok || row.times.min <= 0) continue;
    ceilings.gflops = std::max(ceilings.gflops, row.cost.flops / row.times.min * 1e-6);
    if (row.cost.bytes > 0)
      ceilings.bandwidths.push_back({row.cost.working_set, row.cost.bytes / row.times.min * 1e-6});
    if (row.name == "ceiling/launch") ceilings.launch_ms = row.times.min;
  }
  std::sort(ceilings.bandwidths.begin(), ceilings.bandwidths.end(),
            [](const Bandwidth& a, const Bandwidth& b) { return a.working_set < b.working_set; });
  return ceilings;
}

void bind(const Ceilings& ceilings, Row& row) {
  if (row.times.median <= 0) return;
  const double bandwidth = ceilings.gbps(row.cost.working_set);
  const std::pair<double, const char*> least_ms[] = {
      {ceilings.gflops > 0 ? row.cost.flops / ceilings.gflops * 1e-6 : 0, "fma"},
      {bandwidth > 0 ? row.cost.bytes / bandwidth * 1e-6 : 0, "bandwidth"},
      {ceilings.launch_ms, "launch"}};
  const auto& [ms, what] = *std::max_element(std::begin(least_ms), std::end(least_ms));
  if (ms <= 0) return;
  row.ceiling = what;
  row.ceiling_share = ms / row.times.median;
}

}  // namespace clpv::bench
