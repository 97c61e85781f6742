// SPDX-License-Identifier: MIT
#include "pipeline/inject/emit.hpp"

#include <span>

namespace clpv {
namespace {

constexpr cl_uint kRow = 256;      // points per row, since injection reads surfaces by rows
const cl::NDRange kEmitGroup(16);  // work-items with textures run long

ProgramSource emit_program(const SceneBuffers& scene) {
  ProgramSource source{"inject/emit.cl"};
  source.literals.flag("CLPV_TEXTURED", scene.textured).flag("CLPV_MASKED", scene.masked);
  return source;
}

}  // namespace

Emitter::Emitter(Session& session, const SceneBuffers& scene)
    : session_(session), scene_(scene), emit_(session, emit_program(scene), "emit") {}

void Emitter::emit(const EmissionPlan& plan, float scale) {
  const cl_uint rows = (plan.points + kRow - 1) / kRow, places = rows * kRow;
  points_.view.width = kRow, points_.view.height = rows;
  if (places == 0) return;
  const std::size_t bytes = places * sizeof(cl_float4);
  session_.reserve(parts_, plan.parts.size() * sizeof(ClpvEmitter), "parts of emissive triangles");
  session_.reserve(points_.position, bytes, "points of emissive triangles");
  session_.reserve(points_.normal, bytes, "points of emissive triangles");
  session_.reserve(points_.colour, bytes, "points of emissive triangles");
  session_.write(parts_, plan.parts);
  emit_
      .set(parts_, static_cast<cl_uint>(plan.parts.size()), cl_uint{plan.points}, places, scale,
           scene_.vertices, scene_.triangles, scene_.materials, cl_uint{scene_.white},
           scene_.textures, scene_.texels, points_.position, points_.normal, points_.colour)
      .launch(cl::NDRange(places), kEmitGroup);
}

}  // namespace clpv
