#include "pipeline/propagate.hpp"

#include <algorithm>

#include "support/error.hpp"

namespace clpv {
namespace {

// Operations of a step up to which a work-item serves all three channels, to read a cell's transmittance once. Beyond,
// it is the code that counts: compilers take long over it, and registers run out.
constexpr int kLargestShared = 400;

}  // namespace

Propagator::Propagator(Session& session, const Basis& basis, const Transport& transport,
                       const PropagateOptions& options)
    : session_(session),
      basis_(basis),
      transport_(transport),
      options_(options),
      stencil_(session.device(), options.stencil()) {
  if (options.lobe_time == LobeTime::kernel)
    lobes_.emplace(session, basis, transport, options.state, options.table);
  const bool fluxes = options.state == State::fluxes;
  const VolumeShape light{options.grid, basis.size(), 3};
  const VolumeShape shape{options.grid, fluxes ? 6 : basis.size(), 3};
  const auto make = [&](const VolumeShape& of, const char* what) {
    return std::make_unique<Volume>(session, of, what, options.format);
  };
  for (auto& volume : travelling_) volume = make(shape, "travelling light");
  if (fluxes) sum_ = make(shape, "sum of fluxes");
  if (travelling_[0]->updates_in_place()) return;
  spare_ = make(light, "spare sum of light");
  if (fluxes) travelling_spare_ = make(shape, "spare sum of fluxes");
}

Propagator::Form& Propagator::form(bool first, bool blocking) {
  // With coefficients travelling, the first step is like any other.
  std::optional<Form>& slot = forms_[first && options_.state == State::fluxes ? 1 : 0][blocking ? 1 : 0];
  if (!slot) {
    slot.emplace();
    const State source = first ? State::coefficients : options_.state;
    slot->source =
        transport_source(basis_, transport_, {source, options_.state, blocking, lobes_.has_value()});
    slot->channels = lobes_ || (blocking && slot->source.arrive.flops() <= kLargestShared) ? 3 : 1;
    ProgramSource program{"propagate.cl", {}, slot->source.text};
    if (lobes_) program.generated = lobes_->macros() + program.generated + lobes_->text();
    if (blocking) program.generated += way_macros(transmitter_->transmittance().shape().coefficients);
    program.literals = {{"CLPV_BLOCKING", blocking ? "1" : "0"},
                        {"CLPV_CHANNELS", std::to_string(slot->channels)}};
    stencil_.add_literals(program.literals);
    if (lobes_) lobes_->add_literals(program.literals);
    slot->step = session_.kernel(program, "propagate_step");
    slot->expand = session_.kernel(program, "propagate_expand");
  }
  return *slot;
}

void Propagator::transmit(const Volume& geometry) {
  if (!transmitter_)
    transmitter_ = std::make_unique<Transmitter>(session_, basis_, transport_, options_.stencil());
  transmitter_->transmit(geometry);
}

void Propagator::run_step(Form& form, bool blocking, const Volume& source, const Volume& target,
                          const Volume& sum_so_far, const Volume& sum) {
  form.step.setArg(0, source.memory());
  form.step.setArg(1, target.memory());
  form.step.setArg(2, sum_so_far.memory());
  form.step.setArg(3, sum.memory());
  if (blocking) form.step.setArg(4, transmitter_->transmittance().memory());
  if (lobes_) lobes_->set(form.step);
  stencil_.launch(session_, form.step, form.channels == 3 ? 1 : 3);
}

void Propagator::run_expand(Form& form, const Volume& base, const Volume& sum, const Volume& accumulated) {
  form.expand.setArg(0, base.memory());
  form.expand.setArg(1, sum.memory());
  form.expand.setArg(2, accumulated.memory());
  stencil_.launch(session_, form.expand, 3);
}

Volume& Propagator::before_late(const PropagateVolumes& volumes) {
  return spare_ ? *spare_ : volumes.accumulated;
}

Propagator::Sums Propagator::prepare_sums(const PropagateVolumes& volumes, int early_steps, int late_steps) {
  const bool fluxes = options_.state == State::fluxes;
  if (late_steps == 0 && volumes.late != nullptr) volumes.late->clear(session_);
  if (fluxes && late_steps > 0 && !late_sum_)
    late_sum_ = std::make_unique<Volume>(session_, sum_->shape(), "late sum of fluxes", options_.format);
  const auto late_sum = [&](Volume* result, Volume* spare) {
    return late_steps > 0 ? std::optional(RunningSum(*result, spare, late_steps)) : std::nullopt;
  };
  if (fluxes) {
    RunningSum early(*sum_, travelling_spare_.get(), early_steps);
    early.so_far().clear(session_);
    return {early, late_sum(late_sum_.get(), travelling_spare_.get())};
  }
  if (late_steps == 0) return {RunningSum(volumes.accumulated, spare_.get(), early_steps), std::nullopt};
  return {RunningSum(before_late(volumes), &volumes.accumulated, early_steps),
          late_sum(volumes.late, &volumes.accumulated)};
}

void Propagator::expand(Form& form, const PropagateVolumes& volumes, bool late) {
  if (options_.state == State::coefficients) {
    if (late) run_expand(form, before_late(volumes), *volumes.late, volumes.accumulated);
    return;
  }
  if (!late) {
    run_expand(form, volumes.injected, *sum_, volumes.accumulated);
    return;
  }
  volumes.accumulated.clear(session_);
  run_expand(form, volumes.accumulated, *late_sum_, *volumes.late);
  run_expand(form, volumes.injected, *sum_, before_late(volumes));
  run_expand(form, before_late(volumes), *late_sum_, volumes.accumulated);
}

void Propagator::propagate(const PropagateVolumes& volumes, int iterations, const Observer& after_step) {
  // Late steps are t > n/2 but the first.
  const int late_steps =
      volumes.late == nullptr ? 0 : std::min((iterations + 1) / 2, std::max(iterations - 1, 0));
  if (volumes.geometry != nullptr && iterations > 1) transmit(*volumes.geometry);
  Sums sums = prepare_sums(volumes, iterations - late_steps, late_steps);
  if (iterations == 0) volumes.accumulated.copy_from(session_, volumes.injected);

  const Volume* source = &volumes.injected;
  Form* last = nullptr;
  for (int step = 1; step <= iterations; ++step) {
    const bool blocking = volumes.geometry != nullptr && step > 1;
    const Volume& target = *travelling_[static_cast<std::size_t>(step % 2)];
    RunningSum& sum = step > iterations - late_steps ? *sums.late : sums.early;
    // Coefficients add up from the injected field on; fluxes, which it has none of, from zero.
    const bool from_injected = step == 1 && options_.state == State::coefficients;
    if (step == iterations - late_steps + 1) sum.so_far().clear(session_);  // the first late one
    last = &form(step == 1, blocking);
    run_step(*last, blocking, *source, target, from_injected ? volumes.injected : sum.so_far(), sum.next());
    sum.added();
    source = &target;
    if (after_step) after_step(step, target);
  }
  if (last != nullptr) expand(*last, volumes, late_steps > 0);
}

}  // namespace clpv
