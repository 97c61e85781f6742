#include "pipeline/gather.hpp"

#include <cmath>
#include <numbers>

#include "basis/table_kernel.hpp"
#include "device/arguments.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

// Neighbours in a row share cells. Of 64 x 1, 64 x 4, 32 x 8, 16 x 16 and 8 x 8 none was faster on a CPU.
constexpr std::size_t kLocalX = 64, kLocalY = 1;
constexpr cl_uint kVolumeArgument = 6;  // of kernel gather: the packed volumes, or the first image
constexpr double kNegligible =
    1e-12;  // quadrature's noise in a matrix whose entry is 0; the others are near 1

std::size_t pairs(int coefficients) {
  return static_cast<std::size_t>(coefficients + 1) / 2;
}

/// CLPV_EACH_PAIR: of an odd number of coefficients the last is paired with zero.
std::string pair_macros(int coefficients) {
  std::string text = "#define CLPV_NONE(a) 0.0f\n", each = "#define CLPV_EACH_PAIR(DO)";
  for (int i = 0; i < coefficients; ++i) text += fmt::format("#define CLPV_C{}(a) (a).c{}\n", i, i);
  for (int i = 0; i < coefficients; i += 2) {
    const std::string odd = i + 1 < coefficients ? fmt::format("CLPV_C{}", i + 1) : "CLPV_NONE";
    each += fmt::format(" DO({}, CLPV_C{}, {})", i / 2, i, odd);
  }
  return text + each + "\n";
}

/// g(n): 4 b(-n), or alpha(-n) K.
std::string gather_weights(const Transport& transport, int coefficients, bool from_table) {
  std::string text = "CLPV_INLINE Coefficients clpv_gather_weights(const float3 n CLPV_AND_TABLE) {\n";
  text += fmt::format("  const Coefficients a = {};\n  Coefficients g;\n",
                      transport.gathers_cosine ? "clpv_cosine_integrals(-n.x, -n.y, -n.z)"
                      : from_table             ? "clpv_table_basis(-n.x, -n.y, -n.z CLPV_PASS_TABLE)"
                                               : "clpv_basis(-n.x, -n.y, -n.z)");
  for (int j = 0; j < coefficients; ++j) {
    std::string sum;
    for (int i = 0; i < coefficients; ++i) {
      const double weight = transport.gathers_cosine ? transport.gather(i, j) : (i == j ? 4.0 : 0.0);
      if (std::abs(weight) < kNegligible) continue;
      const std::string literal = float_literal(weight);
      sum = sum.empty() ? fmt::format("{} * a.c{}", literal, i)
                        : fmt::format("fma({}, a.c{}, {})", literal, i, sum);
    }
    text += fmt::format("  g.c{} = {};\n", j, sum.empty() ? "0.0f" : sum);
  }
  return text + "  return g;\n}\n";
}

std::string floor_weights(const Basis& basis, const Transport& transport, double floor) {
  std::string text = "CLPV_INLINE Coefficients clpv_floor_weights(void) {\n  Coefficients g;\n";
  const double share = floor * isotropic_share(basis, transport);
  for (int i = 0; i < basis.size(); ++i) {
    text += fmt::format("  g.c{} = {};\n", i,
                        float_literal(share * basis.integrals()[static_cast<std::size_t>(i)]));
  }
  return text + "  return g;\n}\n";
}

/// Gathering by the cosine evaluates no basis function.
LobeOptions looked_up(const Transport& transport, const GatherOptions& options) {
  LobeOptions lobes = options.lobes;
  lobes.table_functions = lobes.table_functions && !transport.gathers_cosine;
  return lobes;
}

std::string cascade_macro(std::size_t cascades) {
  std::string text = "#define CLPV_EACH_CASCADE(DO)";
  for (std::size_t c = 0; c < cascades; ++c) text += fmt::format(" DO({})", c);
  return text + "\n";
}

ProgramSource source_of(const Basis& basis, const Transport& transport, const GatherOptions& options,
                        const LookupTable& table) {
  ProgramSource source;
  source.file = "gather.cl";
  source.literals = {{"CLPV_GRID", std::to_string(options.grid)},
                     {"CLPV_PAIRS", std::to_string(pairs(basis.size()))},
                     {"CLPV_GATHER_OFFSET", float_literal(options.gather_offset)},
                     {"CLPV_INVERSE_BLEND", float_literal(1 / options.blend_cells)},
                     {"CLPV_LATE", options.late_light ? "1" : "0"},
                     {"CLPV_FLOORED", options.floor > 0 ? "1" : "0"}};
  add_format_literals(source.literals, options.format);
  if (options.format.layout == Layout::image) source.literals["CLPV_FILTERED"] = options.filtered ? "1" : "0";
  source.generated =
      table.macros() + coefficient_macros(basis.size()) + pair_macros(basis.size()) + basis.kernel_source();
  if (table.exists()) source.generated += table_basis_source(basis, options.lobes.table_size);
  source.generated += gather_weights(transport, basis.size(), table.exists());
  if (options.floor > 0) source.generated += floor_weights(basis, transport, options.floor);
  return source;
}

void require_sound(const GatherOptions& options) {
  if (options.grid < 1) throw Error(ExitCode::usage, "gather: grid {} is not at least 1", options.grid);
  if (!std::isfinite(options.gather_offset)) {
    throw Error(ExitCode::usage, "gather: offset {} is not finite", options.gather_offset);
  }
  if (!(options.blend_cells > 0)) {
    throw Error(ExitCode::usage, "gather: blend over {} cells; more than 0 allowed", options.blend_cells);
  }
  if (!(options.floor >= 0 && options.floor <= 1)) {
    throw Error(ExitCode::usage, "gather: floor {} outside 0..1", options.floor);
  }
}

}  // namespace

double isotropic_share(const Basis& basis, const Transport& transport) {
  if (!transport.gathers_cosine) return 1 / std::numbers::pi;  // 4 I / s^2, I = energy / (4 pi)
  // The mean over n of alpha_i(n) is Int b_i dw / 4.
  return basis.energy(transport.gather * basis.constant()) / (4 * 4 * std::numbers::pi);
}

Gatherer::Gatherer(Session& session, const Basis& basis, const Transport& transport,
                   const GatherOptions& options)
    : session_(session),
      options_(options),
      coefficients_(basis.size()),
      table_(session, basis, looked_up(transport, options), options.table, TableUse::functions),
      source_(source_of(basis, transport, options, table_)) {
  require_sound(options);
  if (reads_images()) return;
  pack_ = session.kernel(source_, "pack");
  gather_[0] = session.kernel(source_, "gather");
}

cl::Kernel& Gatherer::gather_kernel(std::size_t cascades) {
  const auto [found, made] = gather_.try_emplace(reads_images() ? cascades : 0);
  if (made) {
    ProgramSource source = source_;
    source.generated += cascade_macro(cascades);
    found->second = session_.kernel(source, "gather");
  }
  return found->second;
}

void Gatherer::require_fit(const Surface& camera, const std::vector<ClpvGrid>& grids,
                           const std::vector<const Volume*>& volumes, std::size_t expected) const {
  if (camera.format != RsmFormat::float32)
    throw Error(ExitCode::run_time, "gather: the camera's view is not float32");
  if (volumes.size() != expected) {
    throw Error(ExitCode::run_time, "gather: {} volumes for {} cascades, {} expected", volumes.size(),
                grids.size(), expected);
  }
  for (const Volume* volume : volumes) {
    const VolumeShape& shape = volume->shape();
    if (shape.n != options_.grid || shape.coefficients != coefficients_ || shape.channels != 3) {
      throw Error(ExitCode::run_time,
                  "gather: volume of {}^3 cells, {} coefficients, {} channels; made for {}^3, {}, 3", shape.n,
                  shape.coefficients, shape.channels, options_.grid, coefficients_);
    }
    if (volume->format() != options_.format) {
      throw Error(ExitCode::run_time, "gather: a volume of {}; made for {}", format_name(volume->format()),
                  format_name(options_.format));
    }
  }
}

void Gatherer::reserve(std::size_t volumes, std::size_t cascades) {
  const auto n = static_cast<std::size_t>(options_.grid);
  if (!reads_images() && volumes > reserved_volumes_) {
    packed_ = session_.buffer(volumes * n * n * n * pairs(coefficients_) * sizeof(cl_float8),
                              "gather's packed volumes");
    reserved_volumes_ = volumes;
  }
  if (cascades > reserved_grids_) {
    grids_ = session_.buffer(cascades * sizeof(ClpvGrid), "gather's grids");
    reserved_grids_ = cascades;
  }
}

void Gatherer::pack(const Volume& volume, std::size_t slot) {
  const auto n = static_cast<std::size_t>(options_.grid);
  pack_.setArg(0, volume.memory());
  pack_.setArg(1, packed_);
  pack_.setArg(2, static_cast<cl_uint>(slot * n * n * n));
  session_.launch(pack_, cl::NDRange(n, n, n), cl::NDRange(n, 1, 1));
}

void Gatherer::gather(const Surface& camera, const std::vector<ClpvGrid>& grids,
                      const std::vector<const Volume*>& accumulated, const std::vector<const Volume*>& late,
                      cl::Buffer& irradiance) {
  require_fit(camera, grids, accumulated, grids.size());
  require_fit(camera, grids, late, options_.late_light ? grids.size() : 0);
  const std::size_t per_cascade = options_.late_light ? 2 : 1;
  reserve(grids.size() * per_cascade, grids.size());
  session_.write(grids_, grids);
  cl::Kernel& kernel = gather_kernel(grids.size());
  set_arguments(kernel, camera.view, camera.depth, camera.normal, grids_, static_cast<cl_uint>(grids.size()),
                irradiance);
  if (!reads_images()) kernel.setArg(kVolumeArgument, packed_);
  for (std::size_t slot = 0; slot < grids.size() * per_cascade; ++slot) {
    const Volume& volume = *(slot % per_cascade == 0 ? accumulated : late)[slot / per_cascade];
    if (reads_images()) {
      kernel.setArg(kVolumeArgument + static_cast<cl_uint>(slot), volume.memory());
    } else {
      pack(volume, slot);
    }
  }
  table_.set(kernel);
  session_.launch(kernel, cl::NDRange(camera.view.width, camera.view.height), cl::NDRange(kLocalX, kLocalY));
}

}  // namespace clpv
