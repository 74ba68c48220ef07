#include <nlohmann/json.hpp>

#include "core/kernels/target.h"
#include "tools/lockstone/bench/print/bench_names.h"
#include "tools/lockstone/bench/print/bench_speed_print.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"

namespace lockstone::tool {
namespace {

using Json = nlohmann::ordered_json;

// Mean times a tick.
Json stages_of(const bench::SpeedResult& result) {
  Json json;
  for (const StepStage stage : all_stages())
    json[name_of(stage)] = per(result.sum_of(stage), result.times.size());
  return json;
}

Json pairs_of(const bench::SpeedResult& result, double clock_nanoseconds) {
  Json json = Json::array();
  for (const PairRow& row : pair_rows(result.detail)) {
    const PairProfile& pairs = *row.profile;
    json.push_back({{"kinds", row.name},
                    {"pairs", pairs.pairs},
                    {"in_contact", pairs.in_contact},
                    {"manifolds", pairs.manifolds},
                    {"reused", pairs.reused},
                    {"parted", pairs.parted},
                    {"nanoseconds", net_nanoseconds(pairs, clock_nanoseconds)}});
  }
  return json;
}

Json scene_of(const SpeedReport& report, const bench::SpeedResult& result) {
  const StepReport& last = result.reports.back();
  const double time = result.sum_of_ticks();
  Json json{{"scene", result.scene->name},
            {"threads", result.threads},
            {"ticks", result.times.size()},
            {"status", to_string(result.status())},
            {"final_hash", hash_text(result.hash)},
            {"hashes_agree", result.hashes_agree},
            {"bodies", result.bodies},
            {"contacts", last.contacts},
            {"contact_points", last.contact_points},
            {"saturations", result.sum(&StepReport::saturations)},
            {"tick_ns",
             {{"median", result.quantile_of_ticks(0.5)},
              {"p99", result.quantile_of_ticks(0.99)},
              {"mean", per(time, result.times.size())}}},
            {"ns_per_contact", per(time, result.sum(&StepReport::contacts))},
            {"ns_per_body", per(time, result.sum(&StepReport::moving_bodies))},
            {"hash_ns", result.hash_nanoseconds},
            {"stage_ns", stages_of(result)}};
  if (report.detail) json["pairs"] = pairs_of(result, report.clock_nanoseconds);
  return json;
}

}  // namespace

void print_speed_json(const SpeedReport& report) {
  Json json{{"vectors", lanes::current_target()},
            {"asserts", k_asserts},
            {"clock", report.clock_name},
            {"clock_ns", report.clock_nanoseconds},
            {"scenes", Json::array()}};
  for (const bench::SpeedResult& result : report.results)
    json["scenes"].push_back(scene_of(report, result));
  write_json(json);
}

}  // namespace lockstone::tool
