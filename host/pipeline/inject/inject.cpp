// SPDX-License-Identifier: MIT
#include "pipeline/inject/inject.hpp"

#include "kernels/shared/sort.h"
#include "kernels/shared/subsampling.h"
#include "kernels/shared/view_injection.h"
#include "pipeline/inject/lookup_table.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

// Short segments give many work-items even if one wall fills the view. There are still few enough
// for one work-item to join the segments of a cell.
constexpr std::size_t kMinSegment = 32, kMaxBlocks = 16384;
// Texels that a work-item assigns to cells; a CPU vectorises over them.
constexpr std::size_t kCpuStrip = 32;
// Few, long work-items: small groups spread them over all compute units.
const cl::NDRange kSegments(16);

}  // namespace

Injector::Injector(Session& session, const Basis& basis, const InjectOptions& options)
    : session_(session),
      basis_(basis),
      options_(options),
      table_(session, basis, options.lobes, options.table, TableUse::lobes),
      sorter_(session),
      strip_(session.device().type == "cpu" ? kCpuStrip : 1),
      accumulator_(session) {}

bool Injector::looks_up(Kind kind) const {
  return kind == Kind::light || blocks_by_lobes(options_.blocking);
}

Literals Injector::light_literals() const {
  Literals literals = lobe_literals(basis_, options_.lobes);
  add_coefficient_literals(literals, basis_.size());
  table_.add_literals(literals);
  return literals.flag("CLPV_UNIT_FLUX", options_.unit_flux_lobes);
}

Literals Injector::blocking_literals() const {
  Literals literals;
  add_coefficient_literals(literals, blocking_size(options_.blocking, basis_));
  switch (options_.blocking) {
    case Blocking::areas:
      return literals.flag("CLPV_BLOCKS_BY_AREA", true);
    case Blocking::one_sided:
      table_.add_literals(literals);
      return literals.flag("CLPV_BLOCKS_BY_AREA", false)
          .reals("CLPV_INTEGRALS", basis_.integrals())
          .add(lobe_literals(basis_, options_.lobes));
  }
  return literals;
}

Injector::Kernels Injector::make_kernels(const Variant& variant) const {
  const Kind kind = variant.kind;
  const bool light = kind == Kind::light;
  const Literals both = Literals().flag("CLPV_SURFACE_PAPER", variant.format == RsmFormat::paper);
  ProgramSource find{"inject/find_cells.cl", both},
      sum{light ? "inject/light.cl" : "inject/surfels.cl", both};
  find.literals.flag("CLPV_GEOMETRY", !light)
      .flag("CLPV_IN_FRONT", options_.in_front)
      .number("CLPV_STRIP", strip_)
      .flag("CLPV_VISIBLE", variant.sees)
      .flag("CLPV_POINTS", variant.points);
  sum.literals.add(light ? light_literals() : blocking_literals());
  add_volume_literals(sum.literals, options_.grid, Accumulator::cells_format(options_.format));
  return {Kernel(session_, find, "find_cells"), Kernel(session_, sum, "sum_segments"),
          Kernel(session_, sum, "join_segments")};
}

Injector::Kernels& Injector::kernels(const Variant& variant) {
  auto found = kernels_.find(variant);
  if (found == kernels_.end()) found = kernels_.emplace(variant, make_kernels(variant)).first;
  return found->second;
}

void Injector::reserve(std::size_t texels, std::size_t blocks) {
  sorter_.reserve(texels);
  const std::size_t coefficients = basis_.size();
  session_.reserve(shares_, texels * sizeof(cl_float), "injection, texels");
  session_.reserve(partials_, 2 * blocks * 3 * coefficients * sizeof(cl_float),
                   "injection, partial sums");
  session_.reserve(firsts_, blocks * sizeof(cl_uint), "injection, segments");
}

void Injector::inject(Kind kind, const std::vector<Target>& targets, int stride,
                      const Buffer& occluded) {
  accumulator_.add_to_cells(targets.front().volume, [&](const Volume& cells) {
    inject_cells(kind, targets, stride, occluded, cells.whole());
  });
}

/// `volumes`: buffer of the targets' volumes.
void Injector::inject_cells(Kind kind, const std::vector<Target>& targets, int stride,
                            const Buffer& occluded, const Buffer& volumes) {
  const bool light = kind == Kind::light;
  const Surface& surface = targets.front().surface;
  const unsigned step = stride;
  const std::size_t width = sampled_texels(surface.view.width, step),
                    height = sampled_texels(surface.view.height, step), count = targets.size(),
                    texels = width * height * count;
  if (texels == 0) return;
  cl_uint length = kMinSegment;
  while (length * kMaxBlocks < width * height) length *= 2;
  const cl_uint blocks = (texels + length - 1) / length;
  reserve(texels, blocks);
  std::vector<ClpvInjection> injections;
  for (const auto& [from, grid, volume, cascade] : targets)
    injections.push_back({from.view, grid, from.colour_scale, from.first,
                          static_cast<cl_uint>(volume.place()), cascade});
  session_.reserve(injections_, count * sizeof(ClpvInjection), "surfaces to inject");
  session_.write(injections_, injections);
  Kernels& kernel = kernels({kind, surface.format, surface.points(), occluded.exists()});
  kernel.find_cells.set(injections_, surface.places(), surface.normal, surface.colour,
                        sorter_.keys());
  if (!light) kernel.find_cells.add(shares_, step);
  if (occluded.exists()) kernel.find_cells.add(occluded);
  kernel.find_cells.launch(cl::NDRange((width + strip_ - 1) / strip_, height, count),
                           strip_ > 1 ? cl::NDRange(1, 16, 1) : cl::NDRange(64, 1, 1));
  const std::size_t keys = options_.grid + (light ? 0 : 1);
  sorter_.sort(texels, count * keys * keys * keys);

  kernel.sum_segments.set(injections_, sorter_.sorted(), sorter_.count(), length, blocks,
                          surface.normal);
  if (light) {
    kernel.sum_segments.add(surface.colour);
  } else {
    kernel.sum_segments.add(shares_, step);
  }
  kernel.sum_segments.add(volumes, partials_, firsts_);
  if (looks_up(kind)) table_.add_to(kernel.sum_segments);
  kernel.sum_segments.launch(cl::NDRange(blocks), kSegments, Chain{length});
  kernel.join_segments
      .set(injections_, sorter_.sorted(), sorter_.count(), length, blocks, volumes, partials_,
           firsts_)
      .launch(cl::NDRange(blocks), kSegments);
}

void Injector::inject_light(const std::vector<Target>& targets, const Buffer& occluded) {
  for (const Target& target : targets)
    require_fit(target.volume, {options_.grid, basis_.size(), 3}, options_.format,
                "injection of light");
  inject(Kind::light, targets, 1, occluded);
}

void Injector::inject_geometry(const Surface& surface, const ClpvGrid& grid, Volume& geometry,
                               int stride) {
  if (stride < 1) throw Error(ExitCode::usage, "inject: stride {} is not at least 1", stride);
  require_fit(geometry, {options_.grid + 1, blocking_size(options_.blocking, basis_), 1},
              options_.format, "injection of blockers");
  inject(Kind::geometry, {{surface, grid, geometry}}, stride, {});
}

}  // namespace clpv
