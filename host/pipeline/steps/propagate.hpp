// SPDX-License-Identifier: MIT
// Propagation: moves injected light through the cells of a cascade in n steps (docs/method.md,
// 'Propagation'; Kaplanyan & Dachsbacher 2010).
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "device/session.hpp"
#include "options/stage_options.hpp"
#include "pipeline/inject/lookup_table.hpp"
#include "pipeline/steps/stencil.hpp"
#include "pipeline/steps/transmittance.hpp"
#include "volume/accumulator.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// Volumes that a propagation reads and writes. The caller owns them. All have `grid` cells along
/// each axis, and the geometry volume grid + 1 samples.
struct PropagateVolumes {
  const Volume& injected;  ///< [W/sr], step 0
  /// Blocking potential at the cells' corners; null: nothing blocks.
  const Volume* geometry = nullptr;
  Volume& accumulated;  ///< output: injected field plus the output of every step [W/sr]
};

/// Propagation lobes computed in the kernel, 30 per cell and step, as in the paper
/// (LobeTime::kernel): arguments and literals for kernels/steps/propagate_lobes.cl. Slow, with the
/// same result as constant lobes.
class RunTimeLobes {
 public:
  /// The transport has lobes. Throws as LookupTable does.
  RunTimeLobes(Session& session, const Basis& basis, const Transport& transport,
               TableStorage storage);

  const Literals& literals() const { return literals_; }
  /// Sets the last arguments of a step.
  void add_to(Kernel& step) const;

 private:
  LookupTable table_, functions_;
  Literals literals_;
  Buffer normals_;
  Buffer links_;  ///< direction of the link through each face, and the face's solid angle
};

/// Runs the propagation steps of one basis and transport, for volumes of one grid size.
class Propagator {
 public:
  Propagator(Session& session, const Basis& basis, const Transport& transport,
             const PropagateOptions& options);

  /// Called after each step with its number, from 1, and the propagated light.
  using Observer = std::function<void(int step, const Volume& travelling)>;

  /// The first step does not block light, since light starts on the surfaces that it was injected
  /// at.
  void propagate(const PropagateVolumes& volumes, int iterations, const Observer& after_step = {});

 private:
  Kernel& step(bool blocking);
  void transmit(const Volume& geometry);

  Session& session_;
  const Basis& basis_;
  const Transport& transport_;
  PropagateOptions options_;
  Stencil stencil_;
  std::optional<RunTimeLobes> lobes_;      ///< none: lobes are constants
  std::optional<Kernel> steps_[2];         ///< [blocking]
  std::unique_ptr<Volume> travelling_[2];  ///< ping-pong
  std::unique_ptr<LinkTransmittance> transmitter_;
  Accumulator accumulator_;
};

}  // namespace clpv
