#include "pipeline/propagate.hpp"

#include <algorithm>

#include "support/error.hpp"

namespace clpv {
namespace {

// Operations of a step up to which a work-item serves all three channels, to read a cell's transmittance once. Beyond,
// it is the code that counts: compilers take long over it, and registers run out.
constexpr int kLargestShared = 400;

constexpr std::size_t kWidestGroup =
    64;  // enough to fill 16-wide vectors; wider groups gain nothing on a CPU

}  // namespace

Propagator::Propagator(Session& session, const Basis& basis, const Transport& transport,
                       const PropagateOptions& options)
    : session_(session), basis_(basis), transport_(transport), options_(options) {
  if (options_.local[0] == 0)
    options_.local[0] = std::min<std::size_t>(static_cast<std::size_t>(options_.grid), kWidestGroup);
  const int carried = options_.state == State::fluxes ? 6 : basis.size();
  const VolumeShape shape{options_.grid, carried, 3};
  for (auto& volume : travelling_) volume = std::make_unique<Volume>(session, shape, "travelling light");
  if (options_.state == State::fluxes) sum_ = std::make_unique<Volume>(session, shape, "sum of fluxes");
}

Propagator::Form& Propagator::form(bool first, bool blocking) {
  // With coefficients travelling, the first step is like any other.
  std::optional<Form>& slot = forms_[first && options_.state == State::fluxes ? 1 : 0][blocking ? 1 : 0];
  if (!slot) {
    slot.emplace();
    const State source = first ? State::coefficients : options_.state;
    slot->source = transport_source(basis_, transport_, {source, options_.state, blocking});
    slot->channels = blocking && slot->source.arrive.flops() <= kLargestShared ? 3 : 1;
    ProgramSource program{"propagate.cl", {}, slot->source.text};
    if (blocking) program.generated += way_macros(transmitter_->transmittance().shape().coefficients);
    program.literals = {{"CLPV_GRID", std::to_string(options_.grid)},
                        {"CLPV_BLOCKING", blocking ? "1" : "0"},
                        {"CLPV_CHANNELS", std::to_string(slot->channels)},
                        {"CLPV_LOCAL_X", std::to_string(options_.local[0])},
                        {"CLPV_LOCAL_Y", std::to_string(options_.local[1])}};
    slot->step = session_.kernel(program, "propagate_step");
    slot->expand = session_.kernel(program, "propagate_expand");
  }
  return *slot;
}

void Propagator::transmit(const Volume& geometry) {
  if (!transmitter_) {
    transmitter_ = std::make_unique<Transmitter>(session_, basis_, transport_, options_.grid, options_.local);
  }
  transmitter_->transmit(geometry);
}

cl::NDRange Propagator::per_channel() const {
  const auto n = static_cast<std::size_t>(options_.grid);
  return {n, n, 3 * n};
}

void Propagator::run_step(Form& form, bool blocking, const cl::Memory& source, const cl::Memory& target,
                          const cl::Memory& sum_so_far, const cl::Memory& sum) {
  form.step.setArg(0, source);
  form.step.setArg(1, target);
  form.step.setArg(2, sum_so_far);
  form.step.setArg(3, sum);
  if (blocking) form.step.setArg(4, transmitter_->transmittance().memory());
  const auto n = static_cast<std::size_t>(options_.grid);
  session_.launch(form.step, form.channels == 3 ? cl::NDRange(n, n, n) : per_channel(),
                  {options_.local[0], options_.local[1], 1});
}

void Propagator::run_expand(Form& form, const cl::Memory& base, const cl::Memory& sum,
                            const cl::Memory& accumulated) {
  form.expand.setArg(0, base);
  form.expand.setArg(1, sum);
  form.expand.setArg(2, accumulated);
  session_.launch(form.expand, per_channel(), {options_.local[0], options_.local[1], 1});
}

void Propagator::propagate(const PropagateVolumes& volumes, int iterations, const Observer& after_step) {
  const bool fluxes = options_.state == State::fluxes;
  if (volumes.geometry != nullptr && iterations > 1) transmit(*volumes.geometry);
  if (fluxes) sum_->clear(session_);
  if (iterations == 0) volumes.accumulated.copy_from(session_, volumes.injected);
  if (volumes.late != nullptr) {
    volumes.late->clear(session_);
    if (fluxes && !late_sum_)
      late_sum_ = std::make_unique<Volume>(session_, sum_->shape(), "late sum of fluxes");
    if (fluxes) late_sum_->clear(session_);
  }

  // Coefficients add up in `accumulated` itself, which starts as the injected field; fluxes in a sum of their
  // own.
  const cl::Memory& total = fluxes ? sum_->memory() : volumes.accumulated.memory();
  const cl::Memory* source = &volumes.injected.memory();
  Form* last = nullptr;
  for (int step = 1; step <= iterations; ++step) {
    const bool blocking = volumes.geometry != nullptr && step > 1;
    const bool is_late = volumes.late != nullptr && 2 * step > iterations && step > 1;
    const Volume& target = *travelling_[static_cast<std::size_t>(step % 2)];
    const cl::Memory& sum = !is_late ? total : fluxes ? late_sum_->memory() : volumes.late->memory();
    const cl::Memory& sum_so_far = step == 1 && !fluxes ? volumes.injected.memory() : sum;
    Form& current = form(step == 1, blocking);
    run_step(current, blocking, *source, target.memory(), sum_so_far, sum);
    source = &target.memory();
    last = &current;
    if (after_step) after_step(step, target);
  }
  if (last == nullptr) return;
  if (fluxes) run_expand(*last, volumes.injected.memory(), sum_->memory(), volumes.accumulated.memory());
  if (volumes.late == nullptr) return;
  if (fluxes) {
    run_expand(*last, volumes.late->memory(), late_sum_->memory(), volumes.late->memory());
    run_expand(*last, volumes.accumulated.memory(), late_sum_->memory(), volumes.accumulated.memory());
  } else {
    run_expand(*last, volumes.accumulated.memory(), volumes.late->memory(), volumes.accumulated.memory());
  }
}

}  // namespace clpv
