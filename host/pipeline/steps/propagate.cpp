// SPDX-License-Identifier: MIT
#include "pipeline/steps/propagate.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "support/error.hpp"

namespace clpv {
namespace {

// Maximum operations per step for which a work-item processes all three channels and so reads transmittance once.
// Larger kernels compile slowly and spill registers.
constexpr int kLargestShared = 400;

/// Returns true if channels share a work-item, except for coefficients in float16 planes. With one work-item per
/// channel, sh2 then takes 0.83x the time and srbf8v2 1x; with float32, sh2 would take 1.15x.
bool worth_sharing(const PropagateOptions& options) {
  return options.format.layout != Layout::soa || options.format.storage == Storage::float32 ||
         options.state == State::fluxes;
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
  if (options.lobe_time == LobeTime::kernel)
    lobes_.emplace(session, basis, transport, options.state, options.table);
  const bool fluxes = options.state == State::fluxes;
  const VolumeShape shape{options.grid, fluxes ? 6 : basis.size(), 3};
  const auto make = [&](const char* what) {
    return std::make_unique<Volume>(session, shape, what, options.format);
  };
  for (auto& volume : travelling_) volume = make("travelling light");
  if (fluxes) sum_ = make("sum of fluxes");
}

Propagator::Form Propagator::make_form(bool first, bool blocking) {
  const State from = first ? State::coefficients : options_.state;
  const TransportSource source =
      transport_source(basis_, transport_,
                       {from, options_.state, blocking, lobes_.has_value(), lobes_ && lobes_->evaluates()});
  const bool large = source.arrive.flops() > kLargestShared;
  const int channels = lobes_ || (blocking && !large && worth_sharing(options_)) ? 3 : 1;
  // A separate large kernel for the first step takes seconds to compile and saves almost no time.
  const bool first_too = blocking && large && !lobes_ && options_.state == State::coefficients;
  ProgramSource program{"steps/propagate.cl", stencil_.literals(), source.text};
  if (lobes_) program.generated = lobes_->macros() + program.generated + lobes_->text();
  if (blocking) program.generated += link_macros(transmitter_->transmittance().shape().coefficients);
  program.literals.flag("CLPV_BLOCKING", blocking)
      .flag("CLPV_FIRST_TOO", first_too)
      .integer("CLPV_CHANNELS", channels);
  if (lobes_) lobes_->add_literals(program.literals);
  return {source,
          blocking,
          channels,
          first_too,
          Kernel(session_, program, "propagate_step"),
          Kernel(session_, program, "propagate_expand")};
}

Propagator::Form& Propagator::form(bool first, bool blocking) {
  // For coefficients, the first step equals the other steps.
  std::optional<Form>& slot = forms_[first && options_.state == State::fluxes ? 1 : 0][blocking ? 1 : 0];
  if (!slot) slot.emplace(make_form(first, blocking));
  return *slot;
}

void Propagator::transmit(const Volume& geometry) {
  if (!transmitter_)
    transmitter_ = std::make_unique<LinkTransmittance>(session_, basis_, transport_, options_.stencil());
  transmitter_->transmit(geometry);
}

void Propagator::run_step(Form& form, bool first, const Volume& source, const Volume& target,
                          const Volume& sum_so_far, const Volume& sum) {
  form.step.set(source.memory(), target.memory(), sum_so_far.memory(), sum.memory());
  if (form.blocking) form.step.add(transmitter_->transmittance().memory());
  if (form.first_too) form.step.add(first ? 1.0f : 0.0f);
  if (lobes_) lobes_->add_to(form.step);
  stencil_.launch(form.step, form.channels == 3 ? 1 : 3);
}

void Propagator::propagate(const PropagateVolumes& volumes, int iterations, const Observer& after_step) {
  const bool blocks = volumes.geometry != nullptr && iterations > 1;
  if (blocks) transmit(*volumes.geometry);
  if (sum_) sum_->clear(session_);
  if (iterations == 0) volumes.accumulated.copy_from(session_, volumes.injected);

  Volume& sum = sum_ ? *sum_ : volumes.accumulated;
  const Volume* source = &volumes.injected;
  Form* last = nullptr;
  for (int step = 1; step <= iterations; ++step) {
    const Volume& target = *travelling_[step % 2];
    last = &form(step == 1, blocks && reads_transmittance(step));
    const auto run = [&](const Volume& so_far, const Volume& next) {
      run_step(*last, step == 1, *source, target, so_far, next);
    };
    // Coefficients accumulate onto the injected field; fluxes start at zero.
    if (step == 1 && options_.state == State::coefficients) {
      run(volumes.injected, sum);
    } else {
      accumulator_.add(sum, run);
    }
    source = &target;
    if (after_step) after_step(step, target);
  }
  if (last == nullptr || !sum_) return;
  last->expand.set(volumes.injected.memory(), sum_->memory(), volumes.accumulated.memory());
  stencil_.launch(last->expand, 3);
}

}  // namespace clpv
