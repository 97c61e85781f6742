// SPDX-License-Identifier: MIT
// Writes and reads the records of times (clpv/time_record.hpp).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "clpv/time_record.hpp"
#include "device/timeline.hpp"
#include "support/json_schema.hpp"

namespace clpv {

TimeRecord time_record(std::string stage, std::vector<double> samples_ms);
TimeRecord time_record(const StageMark& mark, std::vector<double> samples_ms);

void to_json(nlohmann::json& json, const TimeRecord& record);
void from_json(const nlohmann::json& json, TimeRecord& record);
/// Rules of records at a place, for example "/times/*"; from_json reads what passes them.
std::vector<Rule> time_rules(const std::string& place);

/// "gather", "gather/cascade:1", "rasterize-rsm/cascade:1/light:0"
std::string name_of(const TimeRecord& record);

}  // namespace clpv
