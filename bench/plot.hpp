// Charts of a benchmark's results, drawn by bench/plot.py.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace clpv::bench {

/// Finds out before the work whether charts can be drawn: Error(run_time) where python3, matplotlib or plot.py is missing
/// (naming which), or `folder` cannot be made or written.
void require_plots(const std::filesystem::path& folder);

/// Writes what the report has into `folder`, as SVG and PNG: layouts, roofline, scaling, bases, frame.
/// Throws Error(run_time) with the script's last words where it fails.
void plot(const nlohmann::json& report, const std::filesystem::path& folder);

}  // namespace clpv::bench
