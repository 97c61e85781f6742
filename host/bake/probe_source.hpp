// SPDX-License-Identifier: MIT
// Where probes have their light from: swept volumes, or path tracing.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "bake/probe_formats.hpp"
#include "bake/probe_grid.hpp"
#include "device/session.hpp"
#include "options/render_options.hpp"
#include "pathtracer/point_tracer.hpp"
#include "scene/scene.hpp"

namespace clpv::bake {

/// Integrals of the light at some probes of a grid.
struct BlockLight {
  std::vector<glm::vec3> integrals;  ///< [probe of the block][integral]
  float noise = 0;                   ///< TracedProbes::noise; 0 without paths
  std::uint32_t samples = 0;         ///< paths per probe; 0 without paths
};

/// Blocks of probes, in an order that does not depend on what was computed before.
class ProbeSource {
 public:
  virtual ~ProbeSource() = default;
  const std::vector<std::vector<std::size_t>>& blocks() const { return blocks_; }
  virtual BlockLight light(std::size_t block) = 0;

 protected:
  std::vector<std::vector<std::size_t>> blocks_;
};

/// Light of the volumes of frames whose finest cascades cover the grid. `formats`: whose integrals
/// follow each other. `options`: of the frames; near field off. Arguments must outlive the source.
/// Probes have the light half a cell off surfaces: cells that walls cut have too little.
/// Throws Error(usage) without a sweep, and for a grid that takes more than kMaxBakeFrames.
std::unique_ptr<ProbeSource> swept_light(Session& session, const SceneData& scene,
                                         const SceneCamera& camera, const RenderOptions& options,
                                         const ProbeGrid& grid,
                                         const std::vector<ProbeFormat>& formats,
                                         pathtracer::PointTracer& tracer);
inline constexpr std::size_t kMaxBakeFrames = 4096;

/// Path-traced light. All blocks have the noise relative to the light of the whole grid.
std::unique_ptr<ProbeSource> traced_light(pathtracer::PointTracer& tracer, const ProbeGrid& grid,
                                          const std::vector<ProbeFormat>& formats,
                                          bool fixed_samples);

/// The integrals of several formats, one after the other.
Moments joined(const std::vector<ProbeFormat>& formats);

}  // namespace clpv::bake
