// SPDX-License-Identifier: MIT
#include "pipeline/steps/propagate.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "support/error.hpp"

namespace clpv {
namespace {

/// 30 x N: the flux through each face by each function's coefficient.
Matrix fluxes(const FaceTransport& scheme) {
  Matrix rows(static_cast<int>(scheme.faces.size()),
              static_cast<int>(scheme.faces.front().flux.size()));
  for (int f = 0; f < rows.rows(); ++f) {
    for (int i = 0; i < rows.columns(); ++i) rows(f, i) = scheme.faces[f].flux[i];
  }
  return rows;
}

/// Tables of kernels/steps/face_flux.h.
Literals face_flux_literals(const Basis& basis, const FaceTransport& scheme) {
  Literals literals;
  add_coefficient_literals(literals, basis.size());
  return literals.integer("CLPV_LINKS", scheme.faces.size())
      .matrix("CLPV_FACE_FLUX", fluxes(scheme));
}

/// Lobes of kernels/steps/propagate.cl.
Literals constant_lobes(const FaceTransport& scheme) {
  std::vector<int> normals;
  for (const Face& face : scheme.faces)
    normals.push_back(static_cast<int>(std::ranges::find(kAxes, face.normal) - kAxes.begin()));
  return Literals()
      .integers("CLPV_FACE_NORMAL", normals)
      .matrix("CLPV_LOBES", transposed(scheme.lobes));
}

}  // namespace

RunTimeLobes::RunTimeLobes(Session& session, const Basis& basis, const Transport& transport,
                           TableStorage storage)
    : table_(session, basis, transport.lobes, storage, TableUse::lobes),
      functions_(session, basis, transport.lobes, storage, TableUse::functions),
      literals_(lobe_literals(basis, transport.lobes)) {
  // Integrals over faces are constants.
  literals_.flag("CLPV_EVALUATE_AT_RUN_TIME", transport.kind == TransportKind::sampled)
      .flag("CLPV_UNIT_FLUX", transport.unit_flux_lobes)
      .flag("CLPV_FROM_TABLE", functions_.exists());
  (table_.exists() ? table_ : functions_).add_literals(literals_);
  std::vector<glm::vec4> normals, links;
  for (const Face& face : std::get<FaceTransport>(transport.scheme).faces) {
    normals.emplace_back(glm::dvec3(face.normal), 0);
    links.emplace_back(face.direction, face.solid_angle);
  }
  normals_ = session.upload(normals, "normals of faces");
  links_ = session.upload(links, "links through faces");
}

void RunTimeLobes::add_to(Kernel& step) const {
  step.add(normals_, links_);
  table_.add_to(step);
  functions_.add_to(step);
}

Propagator::Propagator(Session& session, const Basis& basis, const Transport& transport,
                       const PropagateOptions& options)
    : session_(session),
      basis_(basis),
      transport_(transport),
      options_(options),
      stencil_(
          options.grid, options.format,
          options.lobe_time == LobeTime::kernel ? 1 : lanes_of(session.device(), options.format)),
      accumulator_(session) {
  if (transport.kind == TransportKind::sweep) {
    std::vector<std::string_view> stepped;
    for (const TransportKind kind : stepped_transports()) stepped.push_back(name_of(kind));
    throw Error(ExitCode::usage, "transport: found 'sweep', which takes no steps; allowed here: {}",
                fmt::join(stepped, "|"));
  }
  if (options.lobe_time == LobeTime::kernel)
    lobes_.emplace(session, basis, transport, options.table);
  const VolumeShape shape{options.grid, basis.size(), 3};
  for (auto& volume : travelling_)
    volume = std::make_unique<Volume>(session, shape, "travelling light", options.format);
}

Kernel& Propagator::step(bool blocking) {
  std::optional<Kernel>& step = steps_[blocking ? 1 : 0];
  if (step) return *step;
  ProgramSource program{lobes_ ? "steps/propagate_lobes.cl" : "steps/propagate.cl",
                        stencil_.literals()};
  const auto& scheme = std::get<FaceTransport>(transport_.scheme);
  program.literals.flag("CLPV_BLOCKING", blocking)
      .add(face_flux_literals(basis_, scheme))
      .add(lobes_ ? lobes_->literals() : constant_lobes(scheme));
  return step.emplace(session_, program, lobes_ ? "propagate_lobes" : "propagate_step");
}

void Propagator::transmit(const Volume& geometry) {
  if (!transmitter_)
    transmitter_ = std::make_unique<LinkTransmittance>(session_, basis_, transport_, options_.grid,
                                                       options_.format);
  transmitter_->transmit(geometry);
}

void Propagator::propagate(const PropagateVolumes& volumes, int iterations,
                           const Observer& after_step) {
  const bool blocks = volumes.geometry != nullptr && iterations > 1;
  if (blocks) transmit(*volumes.geometry);
  if (iterations == 0) volumes.accumulated.copy_from(session_, volumes.injected);

  const Volume* source = &volumes.injected;
  for (int step = 1; step <= iterations; ++step) {
    const Volume& target = *travelling_[step % 2];
    Kernel& kernel = this->step(blocks);
    const auto run = [&](const Volume& so_far, const Volume& sum) {
      kernel.set(source->memory(), target.memory(), so_far.memory(), sum.memory());
      if (blocks) kernel.add(transmitter_->transmittance().memory(), step == 1 ? 1.0f : 0.0f);
      if (lobes_) lobes_->add_to(kernel);
      stencil_.launch(kernel, lobes_ ? 1 : 3);  // run-time lobes serve all channels
    };
    if (step == 1) {
      run(volumes.injected, volumes.accumulated);
    } else {
      accumulator_.add(volumes.accumulated, run);
    }
    source = &target;
    if (after_step) after_step(step, target);
  }
}

}  // namespace clpv
