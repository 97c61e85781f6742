// SPDX-License-Identifier: MIT
// Injection: converts surfaces to light and blockers in the cells of volumes (docs/method.md,
// 'Injection').
#pragma once

#include <CL/opencl.hpp>
#include <compare>
#include <map>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "device/kernel.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "options/stage_options.hpp"
#include "pipeline/inject/lookup_table.hpp"
#include "pipeline/inject/sort_by_cell.hpp"
#include "pipeline/raster/surface.hpp"
#include "volume/accumulator.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// Injects into volumes of one basis and grid size. Deterministic to the bit: every cell sums its
/// texels in surface order. Scratch memory grows to the largest surface injected.
class Injector {
 public:
  Injector(Session& session, const Basis& basis, const InjectOptions& options);

  /// A surface, and the volume at `grid` into which its light goes.
  struct Target {
    const Surface& surface;
    const ClpvGrid& grid;
    Volume& volume;
    cl_uint cascade = 0;  ///< whose bits of `occluded` belong to `grid`
  };
  /// Adds the virtual point lights of an RSM or an Emitter to a volume [W/sr]: `grid` cells, 3
  /// channels. Texels that are empty, dark, not finite or outside the grid add nothing. Several
  /// targets have surfaces of one size in the same buffers, and volumes of one array(). `occluded`:
  /// bits of visibility_masks(); with them, light starts in cells that its surface sees.
  void inject_light(const std::vector<Target>& targets, const Buffer& occluded = {});
  void inject_light(const Surface& rsm, const ClpvGrid& grid, Volume& light) {
    inject_light({{rsm, grid, light}});
  }

  /// Merges `surface`, an RSM or a G-buffer, into `geometry`: grid + 1 samples along each axis, 1
  /// channel, in the representation of `blocking`. Surfaces may share walls, so a sample keeps the
  /// blocking share of larger mean. For areas it keeps the larger value of each number. `stride`:
  /// subsampling of the pixels along each axis, at least 1. Each sampled pixel represents its
  /// neighbours.
  void inject_geometry(const Surface& surface, const ClpvGrid& grid, Volume& geometry,
                       int stride = 1);

 private:
  enum class Kind { light, geometry };
  struct Kernels {
    Kernel find_cells, sum_segments, join_segments;
  };
  struct Variant {
    Kind kind;
    RsmFormat format;
    bool points;  ///< points that no view contains
    bool sees;    ///< chooses among cells by visibility
    auto operator<=>(const Variant&) const = default;
  };
  Literals light_literals() const;
  Literals blocking_literals() const;
  Kernels make_kernels(const Variant& variant) const;
  Kernels& kernels(const Variant& variant);
  bool looks_up(Kind kind) const;  ///< true if the kernel uses a look-up table
  void reserve(std::size_t texels, std::size_t blocks);
  void inject(Kind kind, const std::vector<Target>& targets, int stride, const Buffer& occluded);
  void inject_cells(Kind kind, const std::vector<Target>& targets, int stride,
                    const Buffer& occluded, const Buffer& volumes);

  Session& session_;
  const Basis& basis_;
  InjectOptions options_;
  LookupTable table_;
  CellSorter sorter_;
  std::size_t strip_;  ///< texels of a row that one work-item assigns to cells
  std::map<Variant, Kernels> kernels_;
  Accumulator accumulator_;
  Buffer shares_, partials_, firsts_, injections_;
};

}  // namespace clpv
