// SPDX-License-Identifier: MIT
// Suite `factors`: from `--preset paper` to its scheme in buffers of floats with constant lobes,
// one option at a time: each option alone, and one after another. Rows are passes of whole frames
// with indirect shadows, and their sum as in the paper's Table 1, which leaves out the geometry
// volume.
#include <fmt/format.h>

#include <array>
#include <span>

#include "bench/suites.hpp"
#include "clpv/compare.hpp"
#include "times/frame_times.hpp"
#include "volume/volume_format.hpp"

namespace clpv::bench {
namespace {

using Change = std::pair<const char*, const char*>;  // option and value

// In this order on the way: after `evaluate=buffer` no access to a texel is left but RSMs, after
// `lobe=exact` no table, after `lobe-time=host` no lobe that a kernel computes.
constexpr std::array<Change, 8> kChanges{{{"layout", "soa"},
                                          {"evaluate", "buffer"},
                                          {"evaluate", "exact"},
                                          {"lobe", "exact"},
                                          {"lobe-time", "host"},
                                          {"storage", "float"},
                                          {"blocker-stride", "3"},
                                          {"rsm-format", "float"}}};
constexpr const char* kSum = "sum";
constexpr Pass kSummed[] = {Pass::inject_light, Pass::propagate, Pass::gather};

struct TimedFrame {
  std::shared_ptr<const SceneData> scene;
  SceneCamera camera;
  Frame frame;
  FrameTimes times;
  bool warm = false;

  TimedFrame(Session& session, std::shared_ptr<const SceneData> rendered, const std::string& name,
             const RenderOptions& options)
      : scene(std::move(rendered)), camera(scene->camera(name)), frame(session, *scene, options) {}

  void add(const std::vector<StageTime>& stages) {
    if (warm) times.add(stages);  // skips the warm-up, which compiles
    warm = true;
  }
};

/// Session, options, scene and image of the preset, which the cases of a group use.
struct Shared {
  Session& session;
  SuiteOptions options;
  std::shared_ptr<const SceneData> scene = {};
  std::optional<Image> of_preset = {};

  std::shared_ptr<TimedFrame> frame(const RenderOptions& render) {
    if (!scene) scene = scene_of(options);
    return std::make_shared<TimedFrame>(session, scene, options.camera, render);
  }
  /// Indirect light of the preset.
  const Image& reference(const std::string& basis) {
    if (!of_preset) {
      const auto made = frame(published_options(options.settings, basis));
      made->frame.render(made->camera);
      session.queue().finish();
      of_preset = view_image(made->frame, Show::indirect);
    }
    return *of_preset;
  }
};

std::vector<Row> rows_of(Shared& shared, TimedFrame& timed, const Row& frame) {
  const RenderOptions& options = timed.frame.options();
  timed.frame.render(timed.camera);
  shared.session.queue().finish();
  const auto difference =
      compare(view_image(timed.frame, Show::indirect), shared.reference(options.basis)).nrmse;
  auto passes = timed.times.passes();
  std::vector<double>& sum = passes[kSum];
  sum.resize(timed.times.count());
  for (const Pass pass : kSummed) {
    const std::vector<double>& ms = passes.at(std::string(name_of(pass)));
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += ms[i];
  }
  std::vector<Row> rows = pass_rows(passes, frame);
  for (Row& row : rows) {
    row.difference = difference;
    row.volume_bytes =
        stored_bytes(options.format(), {options.grid, timed.frame.basis().size(), 3});
  }
  return rows;
}

Case factor_case(const std::shared_ptr<Shared>& shared, const std::string& basis,
                 std::span<const Change> changes) {
  Problem problem;
  problem.options = published_options(shared->options.settings, basis);
  std::string changed;
  for (const auto& [option, value] : changes) {
    set_option(problem.options, option, value);
    changed += fmt::format("{}{}={}", changed.empty() ? "" : " ", option, value);
  }
  Case made;
  made.row = make_row("factors", "frame", problem, fmt::format("/paper/{}", changed));
  made.row.preset = "paper";
  made.row.changed = changed;
  made.make = [shared, options = problem.options] {
    const auto timed = shared->frame(options);
    Job job;
    job.own_stages = true;
    job.reset = [timed] { timed->frame.invalidate_light(); };
    job.run = [timed] { timed->frame.render(timed->camera); };
    job.after_run = [timed](const std::vector<StageTime>& stages) { timed->add(stages); };
    job.more_rows = [shared, timed](const Row& row) { return rows_of(*shared, *timed, row); };
    return job;
  };
  return made;
}

std::vector<Case> cases(const std::shared_ptr<Shared>& shared, const std::string& basis) {
  std::vector<Case> made;
  const std::span<const Change> changes = kChanges;
  for (std::size_t count = 0; count <= changes.size(); ++count)
    made.push_back(factor_case(shared, basis, changes.first(count)));
  for (std::size_t i = 1; i < changes.size(); ++i)  // the first alone is on the way
    made.push_back(factor_case(shared, basis, changes.subspan(i, 1)));
  return made;
}

std::string factors_table(const std::vector<Row>& rows) {
  std::string text = fmt::format("{:<8} {:>10} {:>8} {:>9} {:>7}  {}\n", "basis", "median ms",
                                 "mad", "MiB", "NRMSE", "changed from --preset paper");
  for (const Row& row : rows) {
    if (row.stage != kSum) continue;
    text += fmt::format("{:<8} {:>10.2f} {:>8.2f} {:>9.2f} {:>7}  {}\n", row.problem->options.basis,
                        row.times.median, row.times.mad,
                        static_cast<double>(row.volume_bytes) / (1 << 20),
                        row.difference ? fmt::format("{:.4f}", *row.difference) : "-",
                        row.changed.empty() ? "-" : row.changed);
  }
  return text +
         "\nmedian: injection, propagation and gathering; MiB: a light volume; NRMSE: of indirect "
         "light, against --preset paper.\n";
}

}  // namespace

Suite factors_suite() {
  return {"factors",
          "from --preset paper to buffers and constant lobes, one option at a time: time, bytes, "
          "difference",
          [](Session& session, const SuiteOptions& options) {
            const auto bases =
                options.bases.empty() ? std::vector<std::string>{"sh2", "srbf8v2"} : options.bases;
            return groups_by_basis(bases, [&session, options](const std::string& basis) {
              return cases(std::make_shared<Shared>(Shared{session, options}), basis);
            });
          },
          factors_table};
}

}  // namespace clpv::bench
