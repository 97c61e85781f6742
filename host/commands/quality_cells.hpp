// SPDX-License-Identifier: MIT
// The cells of a quality run, measured by whoever is free.
#pragma once

#include <string>
#include <vector>

#include "commands/quality_subjects.hpp"
#include "device/session.hpp"
#include "evaluate/quality.hpp"
#include "options/show.hpp"
#include "parallel/team.hpp"

namespace clpv {

/// What is measured of each variant and view.
struct QualityMatrix {
  const std::vector<Subject>& subjects;
  const std::vector<Variant>& variants;
  /// By subject and variant: what its frames are made with.
  std::vector<std::vector<RenderOptions>> options;
  Show show = Show::indirect;
  int frames = 3;
  bool fresh = false;  ///< measures what is kept too
};

/// All cells, by subject, variant and view, at rank 0; elsewhere none. What is kept is not measured again; the rest is handed
/// out, longest first by what kept cells of the same variant took, or by what is estimated, and kept as it comes. By all ranks.
std::vector<QualityCell> measure_all(Team& team, Session& session, const QualityMatrix& matrix,
                                     const QualityStore& store);

}  // namespace clpv
