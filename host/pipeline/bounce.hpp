// SPDX-License-Identifier: MIT
// Stage `bounce`: what a sweep leaves on a cascade's surfaces, sent back by them (kernels/bounce.cl; docs/method.md, 'More
// bounces').
#pragma once

#include <memory>
#include <vector>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "options/stage_options.hpp"
#include "pipeline/sweep_volumes.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// Between sweeps: `light`, `swept` and so on hold a volume for each channel and bin. Deterministic to the bit.
class Bouncer {
 public:
  /// Of options.bounces beyond one: one bounce more, or all.
  Bouncer(Session& session, const SweepOptions& options);

  /// What reflects in a cascade from now on (SceneReflector::reflectors, which must live on), once.
  void reflect(std::size_t cascade, const Volume& reflectors);

  /// What reflects in a cascade sends back 1 W on each face, and what it sends back further, as is known by now: into `light`,
  /// which holds zeros.
  void send_on(std::size_t cascade, const Buffer& light);
  /// What was left of that, swept: from here on light on its way from surface to surface is known for one bounce more.
  void meet_again(std::size_t cascade, const Buffer& swept);

  /// Adds to `light` what surfaces send back of `swept`.
  void bounce(std::size_t cascade, const Buffer& swept, const Buffer& light);

 private:
  SweepVolumes volumes_;
  std::vector<const Volume*> reflectors_, sending_;  ///< once; in all bounces known
  std::vector<std::unique_ptr<Volume>> in_all_;      ///< none where there is but one bounce more
  Kernel bounce_, send_, meet_;
};

}  // namespace clpv
