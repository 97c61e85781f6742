// SPDX-License-Identifier: MIT
#include "pipeline/inject/sort_by_cell.hpp"

#include <algorithm>
#include <bit>

#include "kernels/shared/loops.h"
#include "kernels/shared/sort.h"
#include "support/error.hpp"

namespace clpv {
namespace {

static_assert(1u << CLPV_RUN_BITS == CLPV_LONGEST_RUN);

constexpr std::size_t kMaxTexels = std::size_t{1}
                                   << (32 - CLPV_RUN_BITS);  // limit of the bits in a run's entry
// Longest chunk: a work-item processes it in one loop.
constexpr std::size_t kLongestChunk = CLPV_LONGEST_LOOP / CLPV_LONGEST_RUN * CLPV_LONGEST_RUN;
// Few, long work-items: small groups spread them over all compute units.
const cl::NDRange kLocal(16);
const ProgramSource kSource{"inject/sort_by_cell.cl"};

/// Numbers of texels and of chunks that occupy a device with a small table of counts. On CPUs a
/// chunk is long enough to amortise its column; on GPUs many work-items hide each other's waits.
struct ChunkLimits {
  std::size_t least_texels, most;
};

std::size_t round_up(std::size_t value, std::size_t step) {
  return (value + step - 1) / step * step;
}

}  // namespace

CellSorter::CellSorter(Session& session)
    : session_(session),
      count_runs_(session, kSource, "count_runs"),
      scatter_runs_(session, kSource, "scatter_runs"),
      count_texels_(session, kSource, "count_texels"),
      scatter_texels_(session, kSource, "scatter_texels"),
      prefix_sum_(session),
      run_count_(session.buffer(sizeof(cl_uint), "sort by cell, count")),
      count_(session.buffer(sizeof(cl_uint), "sort by cell, count")) {}

void CellSorter::reserve(std::size_t texels) {
  if (texels > kMaxTexels) {
    throw Error(ExitCode::run_time, "a surface of {} texels; injection sorts at most {}", texels,
                kMaxTexels);
  }
  session_.reserve(keys_, texels * sizeof(cl_uint), "sort by cell, keys");
  session_.reserve(runs_, texels * sizeof(cl_uint2), "sort by cell, runs");
  session_.reserve(sorted_, texels * sizeof(cl_uint2), "sort by cell, result");
}

void CellSorter::sort(std::size_t texels, std::size_t cells) {
  const cl_uint bits = std::bit_width(std::max<std::size_t>(cells, 2) - 1);
  const cl_uint low_bits = (bits + 1) / 2, low_digits = 1u << low_bits,
                high_digits = 1u << (bits - low_bits);
  const ChunkLimits limits =
      session_.device().lanes == 1 ? ChunkLimits{64, 4096} : ChunkLimits{256, 512};
  const cl_uint chunk =
      std::min(kLongestChunk,
               round_up(std::max(limits.least_texels, (texels + limits.most - 1) / limits.most),
                        CLPV_LONGEST_RUN));
  const cl_uint count = texels;
  const cl_uint chunks = (count + chunk - 1) / chunk;
  const std::size_t low_counts = std::size_t{low_digits} * chunks,
                    high_counts = std::size_t{high_digits} * chunks;
  session_.reserve(counts_, (low_counts + 1) * sizeof(cl_uint), "sort by cell, counts");

  const Chain chain{chunk};
  count_runs_.set(keys_, count, chunk, chunks, low_bits, counts_)
      .launch(cl::NDRange(chunks), kLocal, chain);
  prefix_sum_.run(counts_, low_counts, run_count_);
  scatter_runs_.set(keys_, count, chunk, chunks, low_bits, counts_, runs_)
      .launch(cl::NDRange(chunks), kLocal, chain);

  count_texels_.set(runs_, run_count_, chunk, chunks, low_bits, high_digits, counts_)
      .launch(cl::NDRange(chunks), kLocal, chain);
  prefix_sum_.run(counts_, high_counts, count_);
  scatter_texels_.set(runs_, run_count_, chunk, chunks, low_bits, counts_, sorted_)
      .launch(cl::NDRange(chunks), kLocal, chain);
}

}  // namespace clpv
