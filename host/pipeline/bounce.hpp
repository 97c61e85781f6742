// SPDX-License-Identifier: MIT
// Stage `bounce`: what a sweep leaves on a cascade's surfaces, sent back by them (kernels/bounce.cl; docs/method.md, 'More
// bounces').
#pragma once

#include <array>
#include <memory>
#include <optional>
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
  /// Of options.bounces beyond one: one bounce more, or all. Of all, the coarsest cascade finds out what is sent back further, and the
  /// finer ones go by what falls on surfaces there.
  Bouncer(Session& session, const SweepOptions& options);

  /// What reflects in a cascade from now on (ReflectorVoxelizer::reflectors, which must live on), once.
  void reflect(std::size_t cascade, const Volume& reflectors);

  /// What reflects in the coarsest cascade sends back 1 W on each face, and what it sends back further, as is known by now: into
  /// `light`, which holds zeros.
  void send_on(const Buffer& light);
  /// What was left of that, swept: from here on light on its way from surface to surface is known for one bounce more.
  void meet_again(const Buffer& swept);

  /// Adds to `light` what surfaces send back of `swept`.
  void bounce(std::size_t cascade, const Buffer& swept, const Buffer& light);
  /// Adds to `light` what those of the coarsest cascade send back of `first`, and of `second` with all that is sent back of it further on,
  /// from where they are.
  void bounce_on(const Buffer& first, const Buffer& second, const Buffer& light);

  /// Where a sweep leaves what falls on faces in a cascade, all bounces in it (sweep_collect.cl); null for the finest.
  const Buffer* arriving(std::size_t cascade) const {
    return cascade == 0 ? nullptr : &arriving_[cascade - 1];
  }
  /// Adds to `light` what surfaces send back of that in the next coarser cascade. `offset`: offset_in_coarser().
  void bounce_finer(std::size_t cascade, const std::array<int, 3>& offset, const Buffer& light);

 private:
  SweepVolumes volumes_;
  std::vector<const Volume*> reflectors_;
  const Volume* sending_ = nullptr;  ///< of the coarsest: once, or in all bounces known
  std::unique_ptr<Volume> in_all_;   ///< null where there is but one bounce more
  std::vector<Buffer> arriving_;     ///< on each side, of all cascades but the finest; none as well
  Kernel bounce_;
  std::optional<Kernel> send_, meet_, on_, finer_;
};

}  // namespace clpv
