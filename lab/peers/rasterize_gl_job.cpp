// SPDX-License-Identifier: MIT
#include "peers/peers.hpp"
#include "peers/rasterize_gl.hpp"

namespace clpv::bench {

Job rasterize_gl_job(RasterTask drawn) {
  const auto task = std::make_shared<RasterTask>(std::move(drawn));
  const auto gl =
      std::make_shared<GlRasterizer>(*task->scene, task->pass, task->views, task->light);
  Job job;
  job.own_stages = true;  // nothing runs on the device: wall time
  job.run = [gl] { gl->draw(); };
  if (task->pass != Pass::rasterize_shadow)
    job.compare = [gl, task] { return compare_with_rays(*task, gl->depths()); };
  job.cost = cost_of(*task);
  return job;
}

}  // namespace clpv::bench
