// SPDX-License-Identifier: MIT
// Parts of `clpv bake`: its options, its grid, its files and its errors.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bake/bake.hpp"
#include "cli/options.hpp"
#include "cli/render_request.hpp"
#include "support/named_enum.hpp"

namespace clpv {

enum class BakeSource { sweep, pathtrace };

template <>
inline constexpr auto kNames<BakeSource> = name_list("sweep", "pathtrace");

namespace bake_command {

using namespace bake;

struct Options {
  RenderRequest request;
  TracingOptions tracing;
  BakeSource from = BakeSource::sweep;
  std::string output, points, bounds, probes, format = "ambient-cube-mean";
  double spacing = 0, time = 0;
  bool direct = false, no_dilate = false;
  std::size_t check = 0;
  std::vector<CLI::Option*> of_paths = {};  ///< without effect on swept light
};

/// Extension of the output: ".ktx2" or ".npz".
std::string suffix_of(const Options& options);
/// The file that describes the output; empty without one.
std::string description_file(const Options& options);

/// The grid, within the limits of memory. `numbers`: coefficients of a probe. Throws Error(usage).
ProbeGrid grid_of(const Options& options, const SceneData& scene, std::size_t numbers);

/// Options of a sweep's frames, without the near field, which only pixels of a camera have. More
/// and finer cascades, unless they are given, until a cell is not larger than the spacing.
RenderOptions frame_options(const Options& options, const SceneData& scene, const ProbeGrid& grid);

/// Points with their truth, for errors: random ones in a grid, or those given.
class Check {
 public:
  Check(const Options& options, pathtracer::PointTracer& tracer, const ProbeGrid& grid,
        std::vector<SurfacePoint> given = {});
  /// Lines for people; the truth's too where points are given.
  std::string header() const;
  std::string row(const ProbeFormat& format, const BakedProbes& baked) const;
  /// The numbers of a row of random points; null for what is unknown.
  nlohmann::json error(const ProbeFormat& format, const BakedProbes& baked) const;
  /// Logs numbers of points, and why errors are unknown.
  void report(const ProbeGrid& grid) const;

 private:
  bool given_;
  double noise_[2] = {};
  CheckPoints surfaces_, air_;  // the given ones are surfaces
};

/// Writes the output and its description, or neither. `error`: null without --check.
void write_probes(const Options& options, const SceneData& scene, const ProbeFormat& format,
                  const BakedProbes& baked, const GridLight& light, const nlohmann::json& error);

}  // namespace bake_command
}  // namespace clpv
