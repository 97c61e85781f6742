// SPDX-License-Identifier: MIT
// Bakes probes: light of a source, in a format, with probes inside walls filled from others
// (docs/bake.md).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bake/probe_formats.hpp"
#include "bake/probe_grid.hpp"
#include "bake/probe_source.hpp"
#include "support/cache_folder.hpp"

namespace clpv::bake {

/// Integrals of all probes of a grid: [probe][integral].
struct GridLight {
  std::size_t count = 0;  ///< integrals per probe
  std::vector<glm::vec3> integrals;
  std::uint32_t samples = 0;  ///< maximum number of paths per probe
  double noise = 0;           ///< root mean square over all blocks
};

/// Blocks of an interrupted bake, in a cache. The key, of letters and digits, has all inputs.
/// Blocks of other bakes stay for 30 days, at most 1 GiB of them.
class BlockCache {
 public:
  /// No folder: nothing is kept.
  BlockCache(const std::optional<std::filesystem::path>& folder, std::string key);
  std::optional<BlockLight> read(std::size_t block, std::size_t numbers) const;
  /// Warns if the block cannot be kept; nothing is kept from then on.
  void write(std::size_t block, const BlockLight& light);
  bool keeps() const { return folder_.has_value(); }
  /// Removes the blocks of this bake below `count`.
  void clear(std::size_t count);

 private:
  std::string name_of(std::size_t block) const;

  std::optional<CacheFolder> folder_;
  std::string key_;
};

/// Light of all blocks. Throws Error(run_time) for light that is not finite. `done` receives the
/// number of blocks that are finished.
GridLight light_of(ProbeSource& source, const ProbeGrid& grid, std::size_t count, BlockCache& cache,
                   const std::function<void(std::size_t)>& done);

/// Probes in a format.
struct BakedProbes {
  ProbeGrid grid;
  std::vector<glm::vec3> coefficients;  ///< [probe][number], red, green, blue
  std::vector<std::uint8_t> valid;      ///< 1, or 0 inside walls
  bool filled = false;                  ///< invalid probes have the light of valid ones, if any
  double negative = 0;                  ///< mean negative_share() of all probes
};

/// Marks probes that see more backs than fronts of surfaces, and backs in a quarter of all
/// directions: those are inside walls. Double-sided surfaces have no back.
std::vector<std::uint8_t> validity(pathtracer::PointTracer& tracer,
                                   std::span<const glm::dvec3> positions);

/// Encodes `format`'s integrals, which begin at `first` of each probe. Throws as light_of().
/// `dilate`: fills probes that are not valid. `threads`: 0 for one per processor; the result is the
/// same with any number.
BakedProbes encoded(const ProbeFormat& format, const GridLight& light, std::size_t first,
                    const ProbeGrid& grid, std::vector<std::uint8_t> valid, bool dilate,
                    int threads = 0);

}  // namespace clpv::bake
