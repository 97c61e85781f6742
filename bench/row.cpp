#include "bench/row.hpp"

#include <nlohmann/json.hpp>

namespace clpv::bench {
namespace {

nlohmann::json text_or_null(const std::string& text) {
  return text.empty() ? nlohmann::json(nullptr) : nlohmann::json(text);
}

/// NaN, which JSON has not, as null.
nlohmann::json number_or_null(const std::optional<double>& value) {
  return value && *value == *value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

}  // namespace

const char* name_of(Status status) {
  switch (status) {
    case Status::ok:
      return "ok";
    case Status::unsupported:
      return "unsupported";
    case Status::wrong:
      return "wrong";
  }
  return "";
}

double Row::gflops() const {
  return times.median > 0 ? cost.flops / times.median * 1e-6 : 0;
}

double Row::gbps() const {
  return times.median > 0 ? cost.bytes / times.median * 1e-6 : 0;
}

nlohmann::json to_json(const Row& row, int index) {
  const Variant& v = row.variant;
  const bool propagated = v.iterations > 0;
  nlohmann::json json = {{"name", row.name},
                         {"run_name", row.name},
                         {"run_type", "iteration"},
                         {"family_index", index},
                         {"per_family_instance_index", 0},
                         {"repetitions", row.samples_ms.size()},
                         {"repetition_index", 0},
                         {"threads", 1},
                         {"real_time", row.times.median},
                         {"cpu_time", row.cpu_ms},
                         {"time_unit", "ms"}};
  json.update({{"suite", row.suite},
               {"stage", row.stage},
               {"basis", text_or_null(v.basis)},
               {"n", row.n > 0 ? nlohmann::json(row.n) : nlohmann::json(nullptr)},
               {"layout", text_or_null(v.layout)},
               {"storage", text_or_null(v.storage)},
               {"state", text_or_null(v.state)},
               {"lobe", text_or_null(v.lobe)},
               {"transport", text_or_null(v.transport)},
               {"occlusion", v.occlusion},
               {"grid", v.grid > 0 ? nlohmann::json(v.grid) : nlohmann::json(nullptr)},
               {"iterations", propagated ? nlohmann::json(v.iterations) : nlohmann::json(nullptr)},
               {"cascade", v.cascade ? nlohmann::json(*v.cascade) : nlohmann::json(nullptr)},
               {"filtered", v.filtered},
               {"axis", text_or_null(row.axis)},
               {"value", row.axis.empty() ? nlohmann::json(nullptr) : nlohmann::json(row.value)},
               {"preset", text_or_null(row.preset)}});
  json.update({{"status", name_of(row.status)},
               {"reason", text_or_null(row.reason)},
               {"timer", row.from_events ? "event" : "wall"},
               {"samples_ms", row.samples_ms},
               {"min", row.times.min},
               {"median", row.times.median},
               {"p95", row.times.p95},
               {"max", row.times.max},
               {"mad", row.times.mad},
               {"wall_ms", row.wall_ms},
               {"first_launch_ms", row.first_launch_ms},
               {"build_ms", row.build_ms}});
  json.update({{"flops", row.cost.flops},
               {"bytes", row.cost.bytes},
               {"working_set", row.cost.working_set},
               {"reads_per_cell", row.cost.reads_per_cell},
               {"writes_per_cell", row.cost.writes_per_cell},
               {"gflops", row.gflops()},
               {"gbps", row.gbps()},
               {"ceiling", text_or_null(row.ceiling)},
               {"ceiling_share", row.ceiling_share},
               {"max_rel_error", number_or_null(row.max_rel_error)},
               {"tolerance", row.tolerance}});
  return json;
}

}  // namespace clpv::bench
