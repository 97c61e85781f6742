// SPDX-License-Identifier: MIT
#include "pipeline/bounce.hpp"

#include "basis/bounce.hpp"
#include "codegen/bounce_source.hpp"

namespace clpv {
namespace {

constexpr int kChannels = 3;

}  // namespace

Bouncer::Bouncer(Session& session, const SweepOptions& options)
    : volumes_(session, options.grid, options.format),
      reflectors_(options.parts.size()),
      sending_(options.parts.size()),
      bounce_(session, volumes_.program("bounce.cl", bounce_source_text()), "bounce"),
      send_(session, volumes_.program("bounce.cl", bounce_source_text()), "bounce_send"),
      meet_(session, volumes_.program("bounce.cl", bounce_source_text()), "bounce_meet") {
  if (options.bounces != Bounces::all) return;
  const VolumeShape shape{options.grid, kReflectingSides, kChannels};
  for (std::size_t c = 0; c < options.parts.size(); ++c)
    in_all_.push_back(std::make_unique<Volume>(session, shape, "reflectors of all bounces", options.format));
}

void Bouncer::reflect(std::size_t cascade, const Volume& reflectors) {
  reflectors_[cascade] = sending_[cascade] = &reflectors;
}

void Bouncer::send_on(std::size_t cascade, const Buffer& light) {
  send_.set(sending_[cascade]->memory(), light);
  volumes_.launch(send_, kChannels);
}

void Bouncer::meet_again(std::size_t cascade, const Buffer& swept) {
  meet_.set(swept, reflectors_[cascade]->memory(), in_all_[cascade]->memory());
  volumes_.launch(meet_, kChannels);
  sending_[cascade] = in_all_[cascade].get();
}

void Bouncer::bounce(std::size_t cascade, const Buffer& swept, const Buffer& light) {
  bounce_.set(swept, sending_[cascade]->memory(), light);
  volumes_.launch(bounce_, kChannels);
}

}  // namespace clpv
