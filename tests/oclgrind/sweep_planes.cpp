// SPDX-License-Identifier: MIT
// Runs the form of a sweep that devices of many thousand work-items take, which Oclgrind's, as a
// CPU, does not.
#include "basis/sweep.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/sweep/sweep.hpp"
#include "scene/sky.hpp"

int main() {
  using namespace clpv;
  constexpr int kGrid = 3;
  Session session(choose_device());
  const auto basis = make_basis("sh3");
  const Transport transport = make_transport(TransportKind::sweep, *basis, {}, Blocking::areas);
  const Sky sky = constant_sky(glm::vec3(1));
  Sweeper sweeper(
      session, *basis, transport,
      {.grid = kGrid, .parts = {1, 1}, .blocking = true, .form = SweepForm::planes, .sky = &sky});
  const Volume light(session, {kGrid, basis->size(), 3}, "light"),
      blockers(session, {kGrid + 1, 3, 1}, "blockers");
  Volume swept(session, {kGrid, swept_basis()->size(), 3}, "swept");
  const std::vector<ClpvGrid> grids = cascade_grids(glm::vec3(0.1f), 2, 1, kGrid);
  for (const std::size_t cascade : {1, 0}) {
    sweeper.set_blockers(cascade, blockers);
    sweeper.sweep({cascade, grids, light}, swept);
  }
  session.queue().finish();
}
