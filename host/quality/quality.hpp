// SPDX-License-Identifier: MIT
// How far frames are from the path-traced truth, and what they cost: one cell a variant and view.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/frame.hpp"
#include "quality/cached_reference.hpp"

namespace clpv {

/// One option that varies, and its values.
struct VariedOption {
  std::string name;
  std::vector<std::string> values;
};

/// From "OPTION=a,b,c". Throws Error(usage) where the form, the option or a value is wrong, or a value comes twice.
VariedOption parse_varied(const std::string& text);

/// Values of the varied options, by name, in the order they were given.
using Variant = std::vector<std::pair<std::string, std::string>>;

/// Every combination, the last option varying fastest; one empty variant where nothing varies.
/// Throws Error(usage) where an option comes twice.
std::vector<Variant> combinations(const std::vector<VariedOption>& varied);

/// "basis=sh2 transport=exact"
std::string describe(const Variant& variant);

/// What one variant makes of one view of a scene.
struct QualityCell {
  std::string scene, camera;
  Variant variant;
  std::string rejected;         ///< why this variant cannot be rendered; empty: it was
  std::optional<double> nrmse;  ///< rmse over rms of the reference, over the valid pixels
  std::optional<double> best_gain, nrmse_best_gain;
  std::optional<double> energy_ratio;      ///< sum of the frame over sum of the reference
  std::optional<double> perceptual;        ///< share of the valid pixels that fail the perceptual test (Yee)
  double frame_ms = 0;                     ///< all stages
  std::map<std::string, double> stage_ms;  ///< median over the timed frames; cascades and lights added up
  bool from_events = true;                 ///< times told by the device; false: wall time
  unsigned compute_units = 0;              ///< of the device, or the part of it, that took these times
  double made_s = 0;      ///< what making the frame took; 0 where it was there, of another view
  double measured_s = 0;  ///< what measuring it took, all told
};

/// Renders a frame to warm up and `frames` timed ones, and compares the view `show` of the last with the truth.
/// Fills all but names and variant. Throws what Frame and compare throw.
QualityCell measure(Session& session, Frame& frame, const Camera& camera, const reference::Reference& truth,
                    Show show, int frames);

/// Names everything a cell's errors depend on: truth, device (but not into how many parts it is split), options, what is shown
/// and how it is timed, kernels and program.
std::string quality_key(const reference::Reference& truth, const Device& device, const RenderOptions& options,
                        Show show, int frames);

/// Cells kept on disk, so that a stopped run goes on where it was.
class QualityStore {
 public:
  /// Creates the folder where it is not there. Throws Error(run_time) where it cannot be written.
  explicit QualityStore(std::filesystem::path folder);

  /// None where there is none, or where what is there cannot be read (told in the log).
  std::optional<QualityCell> find(const std::string& key) const;
  void keep(const std::string& key, const QualityCell& cell) const;

 private:
  std::filesystem::path file(const std::string& key) const;

  std::filesystem::path folder_;
};

/// The means of a variant over all its views.
struct QualitySummary {
  Variant variant;
  int views = 0, rejected = 0;
  double nrmse = 0, worst_nrmse = 0, nrmse_best_gain = 0, energy_ratio = 0, perceptual = 0, frame_ms = 0;
  std::map<std::string, double> stage_ms;
};

/// One a variant, least mean error first, those with a rejected view last.
std::vector<QualitySummary> summarise(const std::vector<QualityCell>& cells);

nlohmann::json to_json(const QualityCell& cell);
/// Throws nlohmann::json::exception where the JSON is no cell.
QualityCell cell_from_json(const nlohmann::json& json);
nlohmann::json to_json(const QualitySummary& summary);

/// One line a cell under a line of names: scene, camera, the varied options, errors, frame_ms, then a column a stage.
/// What has no value is an empty field.
std::string quality_csv(const std::vector<QualityCell>& cells);

/// A line a variant, best first: NRMSE of each view and their mean, means of the other figures, and the stages' times.
std::string quality_table(const std::vector<QualityCell>& cells);

}  // namespace clpv
