// SPDX-License-Identifier: MIT
// Errors of frames against the path-traced ground truth, and their times: one cell per variant and
// view.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "clpv/time_record.hpp"
#include "pipeline/frame/frame.hpp"
#include "quality/ground_truth.hpp"
#include "support/cache_folder.hpp"

namespace clpv {

/// One varied option and its values.
struct VariedOption {
  std::string name;
  std::vector<std::string> values;
};

/// Parses "OPTION=a,b,c". Throws Error(usage) for a wrong form, an unknown option, and bad or
/// duplicate values.
VariedOption parse_varied(const std::string& text);

/// Values of the varied options, by name, in the order they were given.
using Variant = std::vector<std::pair<std::string, std::string>>;

/// Returns all combinations, the last option varying fastest; one empty variant if nothing varies.
/// Throws Error(usage) for a duplicate option.
std::vector<Variant> combinations(const std::vector<VariedOption>& varied);

/// "basis=sh2 transport=exact"
std::string describe(const Variant& variant);

/// Results of one variant for one view of a scene.
struct QualityCell {
  std::string scene, camera;
  Variant variant;
  std::string rejected;         ///< reason if this variant cannot be rendered; else empty
  std::optional<double> nrmse;  ///< RMSE / RMS of the ground truth, over the valid pixels
  std::optional<double> best_gain, nrmse_best_gain;
  std::optional<double> energy_ratio;  ///< sum of the frame / sum of the ground truth
  std::optional<double> flip;          ///< mean FLIP of the valid pixels, at the scene's exposure
  /// Times of "frame", the sum of all stages, and of each pass over all cascades and lights.
  std::vector<TimeRecord> times;
  bool from_events = true;     ///< times from device events; false: wall time
  unsigned compute_units = 0;  ///< units of the device or sub-device that was timed
  /// Settings of a baseline: samples, threads and times (quality/baseline.hpp).
  std::map<std::string, double> settings;
  bool cached = false;    ///< measured by an earlier run
  double setup_s = 0;     ///< time to create the frame; 0 if reused from another view
  double measured_s = 0;  ///< total time of the measurement
};

/// Renders a warm-up frame and `frames` timed ones, and compares the view `show` of the last with
/// the ground truth. Sets all fields except names and variant. Throws the errors of Frame and
/// compare.
QualityCell measure(Session& session, Frame& frame, const SceneCamera& camera,
                    const GroundTruth& truth, Show show, int frames);

/// Sets the errors of an image of the view `show`. Throws the errors of compare.
void fill_errors(QualityCell& cell, const Image& image, const GroundTruth& truth, Show show);

/// Cache key over all inputs of a cell, errors and times: times_key(), name and pixels of the
/// ground truth, view and number of timed frames.
std::string quality_key(const GroundTruth& truth, const Device& device,
                        const RenderOptions& options, Show show, int frames, int processors);

/// Cells cached on disk, so that an interrupted run can resume.
class QualityStore {
 public:
  /// Warns if the folder cannot be used.
  explicit QualityStore(std::filesystem::path folder);

  /// Empty if the cell is missing, damaged or not to be trusted (CacheFolder); logs damage.
  std::optional<QualityCell> find(const std::string& key) const;
  /// Stores a cell. The first failure is a warning, and nothing is stored after it.
  void keep(const std::string& key, const QualityCell& cell);

 private:
  void warn_of(const std::string& problem);

  CacheFolder folder_;
  bool writable_ = true;
};

/// Means of a variant over those of its views where the value is defined; empty if there is none.
struct QualitySummary {
  Variant variant;
  int views = 0, rejected = 0, cached = 0;
  int undefined = 0;  ///< rendered views without `nrmse`: its ground truth is black, the frame not
  std::optional<double> nrmse, worst_nrmse, nrmse_best_gain, energy_ratio, flip;
  std::optional<double> frame_ms;          ///< mean of the medians
  std::map<std::string, double> stage_ms;  ///< likewise, of each pass
};

/// One summary per variant, by increasing mean error. Variants with fewer errors in their mean
/// follow: those with undefined errors, at last those with a rejected view.
std::vector<QualitySummary> summarise(const std::vector<QualityCell>& cells);

nlohmann::json to_json(const QualityCell& cell);
/// Throws nlohmann::json::exception if the JSON is not a cell.
QualityCell cell_from_json(const nlohmann::json& json);
nlohmann::json to_json(const QualitySummary& summary);

/// One line per variant, best first: NRMSE of each view, their mean, means of the other metrics,
/// and stage times. Undefined values are '-'.
std::string quality_table(const std::vector<QualityCell>& cells);

}  // namespace clpv
