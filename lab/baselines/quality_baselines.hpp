// SPDX-License-Identifier: MIT
// Baselines of a quality run: other GI methods, given the time of the frame's indirect light.
#pragma once

#include <string>
#include <vector>

#include "baselines/baseline.hpp"
#include "cli/additions.hpp"

namespace clpv {

/// Options --baseline, --baseline-time and --images of `clpv-lab quality`. A baseline that does not
/// have a scene's light is a rejected cell.
class QualityBaselines : public QualityAddition {
 public:
  void add_options(CLI::App& command) override;
  std::string asked() const override;
  std::vector<NamedFile> outputs(const std::vector<Subject>& subjects) const override;
  std::vector<QualityCell> measure(Session& session, const std::vector<Subject>& subjects,
                                   const std::function<RenderOptions(const SceneData&)>& frame_of,
                                   int bounces, Show show, int frames) const override;

 private:
  std::vector<Baseline> names_;
  double time_ = 0;     ///< time of each [ms]; 0: the frame's
  std::string images_;  ///< folder for their images; empty: none
};

}  // namespace clpv
