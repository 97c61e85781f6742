// SPDX-License-Identifier: MIT
// Propagation: the injected light, n steps on through a cascade's cells (docs/method.md, 'Propagation'; Kaplanyan
// & Dachsbacher 2010).
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "codegen/transport_source.hpp"
#include "device/session.hpp"
#include "options/stage_options.hpp"
#include "pipeline/run_time_lobes.hpp"
#include "pipeline/stencil.hpp"
#include "pipeline/transmittance.hpp"
#include "volume/accumulator.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// What a propagation reads and writes. The caller owns the volumes; all have `grid` cells, geometry one more
/// a side.
struct PropagateVolumes {
  const Volume& injected;            ///< [W/sr], step 0
  const Volume* geometry = nullptr;  ///< blocking potential at the cells' corners; null: nothing blocks
  Volume& accumulated;               ///< out: injected field plus every step's output [W/sr]
};

/// Runs the steps of one basis and transport over volumes of one grid size.
class Propagator {
 public:
  Propagator(Session& session, const Basis& basis, const Transport& transport,
             const PropagateOptions& options);

  /// Called after each step with its number, from 1, and what travels then: N coefficients a cell, or six
  /// fluxes.
  using Observer = std::function<void(int step, const Volume& travelling)>;

  /// Light does not block in the first step, in which it leaves the surfaces it was injected at.
  void propagate(const PropagateVolumes& volumes, int iterations, const Observer& after_step = {});

  /// What a later step's kernel executes.
  const TransportSource& step_source(bool blocking) { return form(false, blocking).source; }
  /// Whether a step of something that has blocked reads what the links let through: the first may have to, in vain.
  bool reads_transmittance(int step) { return step > 1 || (transmitter_ && form(false, true).first_too); }
  /// Null until something has blocked.
  const LinkTransmittance* transmitter() const { return transmitter_.get(); }

 private:
  struct Form {
    TransportSource source;
    bool blocking;
    int channels;    ///< a work-item of `step` serves
    bool first_too;  ///< serves the first step as well, told not to block
    Kernel step, expand;
  };
  Form make_form(bool first, bool blocking);
  Form& form(bool first, bool blocking);
  void transmit(const Volume& geometry);
  void run_step(Form& form, bool first, const Volume& source, const Volume& target, const Volume& sum_so_far,
                const Volume& sum);

  Session& session_;
  const Basis& basis_;
  const Transport& transport_;
  PropagateOptions options_;
  Stencil stencil_;
  std::optional<RunTimeLobes> lobes_;      ///< none: they are constants
  std::optional<Form> forms_[2][2];        ///< [first step][blocking]
  std::unique_ptr<Volume> travelling_[2];  ///< ping-pong
  std::unique_ptr<LinkTransmittance> transmitter_;
  std::unique_ptr<Volume> sum_;  ///< of the six fluxes, that light will come from; none: coefficients travel
  Accumulator accumulator_;
};

}  // namespace clpv
