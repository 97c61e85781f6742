// SPDX-License-Identifier: MIT
// The cells of a quality run as text: JSON, CSV and a table to read.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "quality/quality.hpp"

namespace clpv {

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
