// SPDX-License-Identifier: MIT
#include "pipeline/gather/gather.hpp"

#include "basis/bounce.hpp"
#include "pipeline/raster/surface.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

/// Cosine gathering evaluates no basis function.
LobeOptions looked_up(TransportKind transport, const GatherOptions& options) {
  LobeOptions lobes = options.lobes;
  lobes.table_functions = lobes.table_functions && has_faces(transport);
  return lobes;
}

/// Number of float8 in a record, each with two coefficients of three channels.
int packed_pairs(const Basis& basis) {
  return (basis.size() + 1) / 2;
}

/// "DO(0) DO(1)": the numbers of all cascades, for kernels/gather/gather_images.cl.
std::string each_cascade(std::size_t cascades) {
  std::string text;
  for (std::size_t c = 0; c < cascades; ++c) text += fmt::format("DO({}) ", c);
  return text;
}

void add_literals(Literals& literals, const Basis& basis, const GatherOptions& options) {
  literals.real("CLPV_GATHER_OFFSET", options.gather_offset)
      .real("CLPV_INVERSE_BLEND", 1 / options.blend_cells)
      .real("CLPV_LEAST_WHITE", kLeastWhite);
  add_coefficient_literals(literals, basis.size(), "float");
  basis.add_literals(literals);
}

void add_packed_literals(Literals& literals, const Basis& basis, const GatherOptions& options) {
  literals.integer("CLPV_GRID", options.grid)
      .flag("CLPV_VISIBLE", options.gather == Gathering::visible)
      .integer("CLPV_PAIRS", packed_pairs(basis));
}

ProgramSource source_of(const Basis& basis, TransportKind transport, const GatherOptions& options,
                        bool packed, const LookupTable& table) {
  ProgramSource source{packed ? "gather/gather.cl" : "gather/gather_images.cl"};
  add_literals(source.literals, basis, options);
  source.literals.flag("CLPV_FACE_TRANSPORT", has_faces(transport))
      .flag("CLPV_FROM_TABLE", table.exists());
  table.add_literals(source.literals);
  if (packed) {
    add_packed_literals(source.literals, basis, options);
  } else {
    constexpr int kPixels = 8;  // cells are read one by one
    add_volume_literals(source.literals, options.grid, options.format, kPixels);
    source.literals.flag("CLPV_FILTERED", options.filtered);
  }
  return source;
}

}  // namespace

ProgramSource with_radiance(ProgramSource source, const Basis& swept,
                            const GatherOptions& options) {
  add_literals(source.literals, swept, options);
  add_packed_literals(source.literals, swept, options);
  return source;
}

Gatherer::Gatherer(Session& session, const Basis& basis, TransportKind transport,
                   const GatherOptions& options)
    : session_(session),
      options_(options),
      coefficients_(basis.size()),
      furnace_(!has_faces(transport)),
      pairs_(packed_pairs(basis)),
      table_(session, basis, looked_up(transport, options), options.table, TableUse::functions),
      source_(source_of(basis, transport, options, packs(), table_)),
      stencil_(options.grid, options.format, lanes_of(session.device(), options.format)) {
  if (!packs()) return;
  ProgramSource pack{"gather/pack.cl", stencil_.literals()};
  add_coefficient_literals(pack.literals, basis.size());
  pack.literals.integer("CLPV_PAIRS", pairs_).flag("CLPV_FURNACE", furnace_);
  pack_.emplace(session, pack, "pack");
  gather_kernel(0, false);
}

Kernel& Gatherer::gather_kernel(std::size_t cascades, bool points) {
  const std::pair key(packs() ? 0 : cascades, points);
  if (const auto found = gather_.find(key); found != gather_.end()) return found->second;
  ProgramSource source = source_;
  if (points) source.literals.flag("CLPV_POINTS", true);
  if (!packs()) source.literals.word("CLPV_EACH_CASCADE(DO)", each_cascade(cascades));
  return gather_.try_emplace(key, session_, source, packs() ? "gather" : "gather_images")
      .first->second;
}

void Gatherer::require_fit(const GatheredLight& light) const {
  if (light.accumulated.size() != light.grids.size()) {
    throw Error(ExitCode::run_time, "gather: {} volumes for {} cascades", light.accumulated.size(),
                light.grids.size());
  }
  for (const Volume* volume : light.accumulated)
    clpv::require_fit(*volume, {options_.grid, coefficients_, furnace_ ? 4 : 3}, options_.format,
                      "gathering");
  if (sees() && !light.occluded.exists())
    throw Error(ExitCode::run_time, "gather: no occluded cells, which gather 'visible' needs");
}

void Gatherer::reserve(std::size_t cascades) {
  session_.reserve(grids_, cascades * sizeof(ClpvGrid), "gather's grids");
  if (!packs() || cascades <= packed_keys_.size()) return;
  const std::size_t n = options_.grid, pairs = pairs_;
  session_.reserve(packed_, cascades * n * n * n * pairs * sizeof(cl_float8),
                   "gather's packed volumes");
  packed_keys_.assign(cascades, std::nullopt);
}

/// Packs the volumes that are new or changed.
void Gatherer::pack(const GatheredLight& light) {
  const std::size_t n = options_.grid;
  for (std::size_t c = 0; c < light.grids.size(); ++c) {
    const auto key = light.keys.empty() ? std::nullopt : std::optional(light.keys[c]);
    if (key && packed_keys_[c] == key) continue;
    const float white = light.scale * light.grids[c].cell * light.grids[c].cell;
    pack_->set(light.accumulated[c]->memory(), packed_, static_cast<cl_uint>(c * n * n * n), white);
    stencil_.launch(*pack_, 1);
    packed_keys_[c] = key;
  }
}

void Gatherer::take(const GatheredLight& light) {
  require_fit(light);
  reserve(light.grids.size());
  session_.write(grids_, light.grids);
  cascades_ = light.grids.size();
  scale_ = light.scale;
  occluded_ = light.occluded;
  if (packs()) pack(light);
}

void Gatherer::gather(const Surface& camera, const GatheredLight& light, Buffer& irradiance) {
  if (camera.format != RsmFormat::float32)
    throw Error(ExitCode::run_time, "gather: the camera's view is not float32");
  take(light);
  Kernel& kernel = gather_kernel(cascades_, camera.points());
  kernel.set(camera.view, camera.places(), camera.normal, grids_, cascades_, 1 / scale_,
             irradiance);
  if (packs()) {
    kernel.add(packed_);
    if (sees()) kernel.add(occluded_);
  } else {
    for (const Volume* volume : light.accumulated) kernel.add(volume->memory());
  }
  table_.add_to(kernel);
  kernel.launch(items_of(session_, camera.view), pixel_group(session_));
}

void Gatherer::add_radiance(Kernel& kernel) const {
  kernel.add(grids_, cascades_, 1 / scale_, packed_);
  if (sees()) kernel.add(occluded_);
}

}  // namespace clpv
