#include "bench/suites.hpp"

#include "bench/hall.hpp"

namespace clpv::bench {

const std::vector<Suite>& suites() {
  static const std::vector<Suite> all = {table1_suite(), bases_suite(), ceilings_suite()};
  return all;
}

Variant plain_variant(const SuiteOptions& options, const std::string& basis) {
  Variant variant;
  variant.basis = basis;
  variant.grid = options.settings.grid;
  variant.iterations = options.iterations;
  return variant;
}

const Scene& scene_of(const SuiteOptions& options, Scene& hall) {
  if (options.scene != nullptr) return *options.scene;
  hall = make_hall(kHallTriangles);
  return hall;
}

std::shared_ptr<Bench> make_bench(Session& session, const SuiteOptions& options) {
  Scene hall;
  const Scene& scene = scene_of(options, hall);
  return std::make_shared<Bench>(Bench{
      session, std::make_shared<Inputs>(session, scene, scene.camera(options.camera), options.settings), {}});
}

}  // namespace clpv::bench
