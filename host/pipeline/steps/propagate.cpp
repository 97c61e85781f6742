// SPDX-License-Identifier: MIT
#include "pipeline/steps/propagate.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "codegen/transport_source.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

// Maximum operations per step for which a work-item processes all three channels and so reads transmittance once.
// Larger kernels compile slowly and spill registers.
constexpr int kLargestShared = 400;

/// Returns true if channels share a work-item, except for coefficients in float16 planes. With one work-item per
/// channel, sh2 then takes 0.83x the time and srbf8v2 1x; with float32, sh2 would take 1.15x.
bool worth_sharing(const PropagateOptions& options) {
  return options.format.layout != Layout::soa || options.format.storage == Storage::float32;
}

}  // namespace

Propagator::Propagator(Session& session, const Basis& basis, const Transport& transport,
                       const PropagateOptions& options)
    : session_(session),
      basis_(basis),
      transport_(transport),
      options_(options),
      stencil_(session.device(), options.stencil()),
      accumulator_(session) {
  if (transport.kind == TransportKind::sweep) {
    std::vector<std::string_view> stepped;
    for (const TransportKind kind : stepped_transports()) stepped.push_back(name_of(kind));
    throw Error(ExitCode::usage, "transport: found 'sweep', which takes no steps; allowed here: {}",
                fmt::join(stepped, "|"));
  }
  if (options.lobe_time == LobeTime::kernel) lobes_.emplace(session, basis, transport, options.table);
  const VolumeShape shape{options.grid, basis.size(), 3};
  for (auto& volume : travelling_)
    volume = std::make_unique<Volume>(session, shape, "travelling light", options.format);
}

Propagator::Form& Propagator::form(bool blocking) {
  std::optional<Form>& form = forms_[blocking ? 1 : 0];
  if (form) return *form;
  const bool large = step_operations(transport_, blocking).flops() > kLargestShared;
  const int channels = lobes_ || (blocking && !large && worth_sharing(options_)) ? 3 : 1;
  ProgramSource program{"steps/propagate.cl", stencil_.literals(), transport_source(basis_, transport_)};
  if (lobes_) program.generated = lobes_->macros() + program.generated + lobes_->text();
  if (blocking) program.generated += link_text(transmitter_->transmittance().shape().coefficients);
  program.literals.flag("CLPV_BLOCKING", blocking).integer("CLPV_CHANNELS", channels);
  if (lobes_) lobes_->add_literals(program.literals);
  form.emplace(Form{channels, Kernel(session_, program, "propagate_step")});
  return *form;
}

void Propagator::transmit(const Volume& geometry) {
  if (!transmitter_)
    transmitter_ = std::make_unique<LinkTransmittance>(session_, basis_, transport_, options_.stencil());
  transmitter_->transmit(geometry);
}

void Propagator::propagate(const PropagateVolumes& volumes, int iterations, const Observer& after_step) {
  const bool blocks = volumes.geometry != nullptr && iterations > 1;
  if (blocks) transmit(*volumes.geometry);
  if (iterations == 0) volumes.accumulated.copy_from(session_, volumes.injected);

  const Volume* source = &volumes.injected;
  for (int step = 1; step <= iterations; ++step) {
    const Volume& target = *travelling_[step % 2];
    Form& form = this->form(blocks);
    const auto run = [&](const Volume& so_far, const Volume& sum) {
      form.step.set(source->memory(), target.memory(), so_far.memory(), sum.memory());
      if (blocks) form.step.add(transmitter_->transmittance().memory(), step == 1 ? 1.0f : 0.0f);
      if (lobes_) lobes_->add_to(form.step);
      stencil_.launch(form.step, form.channels == 3 ? 1 : 3);
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
