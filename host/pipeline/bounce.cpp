// SPDX-License-Identifier: MIT
#include "pipeline/bounce.hpp"

#include "basis/bounce.hpp"
#include "codegen/sweep_source.hpp"

namespace clpv {
namespace {

constexpr int kChannels = 3;

}  // namespace

Bouncer::Bouncer(Session& session, const SweepOptions& options)
    : volumes_(session, options.grid, options.format),
      reflectors_(options.parts.size()),
      bounce_(session, volumes_.program("bounce.cl", bounce_source_text()), "bounce") {
  if (options.bounces != Bounces::all) return;
  const ProgramSource program = volumes_.program("bounce.cl", bounce_source_text());
  send_.emplace(session, program, "bounce_send");
  meet_.emplace(session, program, "bounce_meet");
  on_.emplace(session, program, "bounce_on");
  finer_.emplace(session, program, "bounce_finer");
  in_all_ = std::make_unique<Volume>(session, VolumeShape{options.grid, kReflectingSides, kChannels},
                                     "reflectors of all bounces", options.format);
  for (std::size_t coarser = 1; coarser < options.parts.size(); ++coarser)
    arriving_.push_back(
        volumes_.make_bordered(kChannels * kReflectingSides, "light on surfaces of a coarser cascade"));
}

void Bouncer::reflect(std::size_t cascade, const Volume& reflectors) {
  reflectors_[cascade] = &reflectors;
  if (cascade + 1 == reflectors_.size()) sending_ = &reflectors;
}

void Bouncer::send_on(const Buffer& light) {
  send_->set(sending_->memory(), light);
  volumes_.launch(*send_, kChannels);
}

void Bouncer::meet_again(const Buffer& swept) {
  meet_->set(swept, reflectors_.back()->memory(), in_all_->memory());
  volumes_.launch(*meet_, kChannels);
  sending_ = in_all_.get();
}

void Bouncer::bounce(std::size_t cascade, const Buffer& swept, const Buffer& light) {
  bounce_.set(swept, reflectors_[cascade]->memory(), light);
  volumes_.launch(bounce_, kChannels);
}

void Bouncer::bounce_on(const Buffer& first, const Buffer& second, const Buffer& light) {
  on_->set(first, second, reflectors_.back()->memory(), sending_->memory(), light);
  volumes_.launch(*on_, kChannels);
}

void Bouncer::bounce_finer(std::size_t cascade, const std::array<int, 3>& offset, const Buffer& light) {
  finer_->set(arriving_[cascade], offset[0], offset[1], offset[2], reflectors_[cascade]->memory(), light);
  volumes_.launch(*finer_, kChannels);
}

}  // namespace clpv
