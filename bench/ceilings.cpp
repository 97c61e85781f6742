// SPDX-License-Identifier: MIT
// Suite `ceilings`: peak fused multiply-adds, bandwidth of streams, and launch time.
#include "bench/ceilings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "bench/suites.hpp"
#include "device/kernel.hpp"
#include "support/error.hpp"
#include "verify/check.hpp"

namespace clpv::bench {
namespace {

// Minimum duration of a sample, far above a clock tick and a launch.
constexpr double kMinSampleMs = 2;
constexpr cl_uint kMaxPasses = 1u << 22;    // results stay integers that a float represents exactly
constexpr int kChains = 12, kUnrolled = 4;  // as in kernels/ceilings.cl
// Work-items per compute unit of a device other than a CPU.
constexpr std::size_t kItemsPerUnit = 2048;

/// Global and local size of a launch.
struct LaunchSize {
  std::size_t items, local;
};

/// Launch size of a stream. A CPU gets one work-item per core, so that each core repeats its share
/// of the working set.
LaunchSize stream_size(const Device& device) {
  if (device.type == "cpu") return {device.compute_units, 1};
  constexpr std::size_t kLocal = 64;
  return {device.compute_units * kItemsPerUnit, kLocal};
}

/// Launch size of arithmetic. The kernel's types are vectors, so that a CPU core runs one work-item
/// at a time; many work-items balance the load.
LaunchSize fma_size(const Device& device) {
  constexpr std::size_t kPerCore = 128;
  if (device.type == "cpu") return {device.compute_units * kPerCore, 1};
  return stream_size(device);
}

/// Number of passes for which `launch(passes)` lasts at least kMinSampleMs.
template <typename Launch>
cl_uint calibrated_passes(Session& session, Launch launch) {
  cl_uint passes = 1;
  launch(passes);
  session.queue().finish();
  while (passes < kMaxPasses) {
    const auto start = std::chrono::steady_clock::now();
    launch(passes);
    session.queue().finish();
    const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - start;
    if (ms.count() >= kMinSampleMs) break;
    passes *= 2;
  }
  return passes;
}

Case ceiling_case(const std::string& name, std::function<Job()> make) {
  Case result;
  result.row.suite = "ceilings";
  result.row.stage = "ceiling";
  result.row.name = "ceiling/" + name;
  result.make = std::move(make);
  return result;
}

/// Deviation of values that must all equal `expected`.
Deviation deviation_from(const std::vector<float>& values, double expected) {
  verify::WorstError worst;
  for (std::size_t i = 0; i < values.size(); ++i)
    worst.take(std::abs(values[i] - expected) / expected, i);
  if (worst.value == 0) return {0, 0, {}};
  return {worst.value, 0,
          fmt::format("value {}: {}, expected {}", worst.at, values[worst.at], expected)};
}

Job fma_job(Session& session, int width) {
  constexpr double kStart = 3;
  constexpr int kMinPasses = 32;  // 128 steps x -> x / 2 + 1 converge to 2 in float
  const LaunchSize size = fma_size(session.device());
  const ProgramSource source{"ceilings.cl",
                             Literals().word("CLPV_VECTOR", fmt::format("float{}", width))};
  auto kernel = std::make_shared<Kernel>(session, source, "fma_peak");
  const Buffer out = session.buffer(size.items * sizeof(float), "ceilings, results");
  const auto launch = [kernel, out, size](cl_uint passes) {
    kernel->set(passes, static_cast<cl_float>(kStart), out).launch(size.items, size.local);
  };
  const cl_uint passes = std::max<cl_uint>(kMinPasses, calibrated_passes(session, launch));
  Job job;
  job.run = [launch, passes] { launch(passes); };
  job.compare = [&session, out, size, width] {
    return deviation_from(session.read<float>(out, size.items), 2.0 * kChains * width);
  };
  job.cost.flops = 2.0 * kChains * kUnrolled * width * passes * static_cast<double>(size.items);
  return job;
}

Job stream_job(Session& session, std::size_t bytes) {
  constexpr std::size_t kWidth = 16;
  const LaunchSize size = stream_size(session.device());
  const std::size_t per_item =
                        std::max<std::size_t>(1, bytes / 3 / (kWidth * sizeof(float)) / size.items),
                    vectors = per_item * size.items, values = vectors * kWidth;
  const std::size_t block = session.device().type == "cpu" ? per_item : 1;
  const ProgramSource source{"ceilings.cl",
                             Literals().word("CLPV_VECTOR", "float16").number("CLPV_BLOCK", block)};
  auto kernel = std::make_shared<Kernel>(session, source, "stream");
  const Buffer a = session.upload(std::vector<float>(values, 1.0f), "ceilings, stream"),
               b = session.upload(std::vector<float>(values, 2.0f), "ceilings, stream"),
               c = session.buffer(values * sizeof(float), "ceilings, stream");
  const auto launch = [=](cl_uint passes) {
    kernel->set(passes, static_cast<cl_uint>(per_item / block), a, b, c)
        .launch(size.items, size.local);
  };
  const cl_uint passes = calibrated_passes(session, launch);
  Job job;
  job.reset = [&session, c, values] { session.fill_zero(c, values * sizeof(float)); };
  job.run = [launch, passes] { launch(passes); };
  job.compare = [&session, c, values, passes] {
    return deviation_from(session.read<float>(c, values), 1.0 + 2.0 * passes);
  };
  job.cost.working_set = 3.0 * static_cast<double>(values) * sizeof(float);
  job.cost.bytes = job.cost.working_set * passes;
  return job;
}

Job launch_job(Session& session) {
  auto kernel = std::make_shared<Kernel>(session, ProgramSource{"ceilings.cl"}, "nothing");
  const Buffer out = session.buffer(sizeof(float), "ceilings, launch");
  Job job;
  job.reset = [&session, out] { session.fill_zero(out, sizeof(float)); };
  job.run = [kernel, out] { kernel->set(out).launch(1, 1); };
  job.compare = [&session, out] { return deviation_from(session.read<float>(out, 1), 1.0); };
  return job;
}

}  // namespace

std::vector<Case> ceiling_cases(Session& session) {
  std::vector<Case> cases;
  for (const int width : {4, 8, 16}) {
    cases.push_back(ceiling_case(fmt::format("fma/{}", width),
                                 [&session, width] { return fma_job(session, width); }));
  }
  // Working sets [KiB], from one core's cache to main memory.
  for (const std::size_t kib : {128u, 512u, 2048u, 8192u, 32768u, 262144u}) {
    const std::string size =
        kib < 1024 ? fmt::format("{}KiB", kib) : fmt::format("{}MiB", kib / 1024);
    cases.push_back(ceiling_case("stream/" + size, [&session, kib] {
      return stream_job(session, std::min(kib << 10, session.largest_buffer() / 2));
    }));
  }
  cases.push_back(ceiling_case("launch", [&session] { return launch_job(session); }));
  return cases;
}

Suite ceilings_suite() {
  return {"ceilings",
          "ceilings of this device: fused multiply-adds, bandwidth, launch time",
          [](Session& session, const SuiteOptions&) {
            return std::vector<Group>{ceiling_cases(session)};
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

void set_ceiling(const Ceilings& ceilings, Row& row) {
  if (row.times.median <= 0) return;
  const double bandwidth = ceilings.gbps(row.cost.working_set);
  const std::pair<double, const char*> min_ms[] = {
      {ceilings.gflops > 0 ? row.cost.flops / ceilings.gflops * 1e-6 : 0, "fma"},
      {bandwidth > 0 ? row.cost.bytes / bandwidth * 1e-6 : 0, "bandwidth"},
      {ceilings.launch_ms, "launch"}};
  const auto& [ms, ceiling] = *std::max_element(std::begin(min_ms), std::end(min_ms));
  if (ms <= 0) return;
  row.ceiling = ceiling;
  row.ceiling_share = ms / row.times.median;
}

}  // namespace clpv::bench
