// SPDX-License-Identifier: MIT
// Additions of another program to the commands: the lab (lab/README.md) adds methods to `quality`,
// suites to `bench`, and commands.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cli/quality_subjects.hpp"
#include "device/session.hpp"
#include "quality/quality.hpp"
#include "support/output_file.hpp"

namespace clpv {

struct Shared;
namespace bench {
struct Suite;
}

/// Cells that stand beside the variants of `clpv quality`. The calls come in this order, once each.
class QualityAddition {
 public:
  virtual ~QualityAddition() = default;
  virtual void add_options(CLI::App& command) = 0;
  /// The option that asks for cells ("--baseline") if the command line has it, else empty.
  virtual std::string asked() const = 0;
  /// Creates the folders of the files that measure() writes, and returns their names. Throws
  /// Error(usage) if two subjects share one.
  virtual std::vector<NamedFile> outputs(const std::vector<Subject>& subjects) const = 0;
  /// Measures the cells of all views of the subjects, which have their ground truths. `frame_of`:
  /// options of the frame that the command line names.
  virtual std::vector<QualityCell> measure(
      Session& session, const std::vector<Subject>& subjects,
      const std::function<RenderOptions(const SceneData&)>& frame_of, int bounces, Show show,
      int frames) const = 0;
};

struct Additions {
  std::shared_ptr<QualityAddition> quality;                  ///< null: none
  const std::vector<bench::Suite>* suites = nullptr;         ///< null: none
  void (*command)(CLI::App& app, Shared& shared) = nullptr;  ///< adds a command; null: none
};

}  // namespace clpv
