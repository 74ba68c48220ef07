#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/bench/queries/query_run.h"
#include "tools/bench/support/measure.h"
#include "tools/lockstone/bench/print/bench_names.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/lockstone/support/options.h"

namespace lockstone::tool {
namespace {

using Json = nlohmann::ordered_json;

struct BenchQueriesOptions {
  bench::QueryOptions measure;
  bool cpu = false;
  bool quick = false;
  bool json = false;
};

const std::map<std::string, bench::QueryWorld> k_worlds{
    {"primitives", bench::QueryWorld::primitives},
    {"hulls", bench::QueryWorld::hulls},
    {"mesh", bench::QueryWorld::mesh}};

double median_of(const bench::QueryTimes& engine) {
  return bench::median(engine.times);
}

// How often it is right, and for closest rays how far off at worst.
void print_agreement(const bench::Agreement& agreement) {
  fmt::print(" {:>7.2f}%", 100 * agreement.same);
  if (agreement.same_body > 0)
    fmt::print(" {:>9.4f}", 1000 * agreement.worst_metres);
  else
    fmt::print(" {:>9}", "");
}

void print_peer(const bench::QueryTimes& peer, double ours) {
  if (peer.times.empty()) {
    fmt::print("  {} has no such query", peer.engine);
    return;
  }
  const double theirs = median_of(peer);
  fmt::print("  {:<12} {:>7.0f}", peer.engine, theirs);
  print_agreement(peer.agreement);
  fmt::print(" {:>6.2f}", ours / theirs);
}

void print_table(const bench::QueryBench& bench) {
  fmt::print("{} bodies, {} of them static, world {}{}\n", bench.bodies, bench.static_bodies,
             hash_text(bench.world_hash), k_build_remark);
  fmt::print(
      "{:<20} {:>6} {:<9} {:>7} {:>7} {:>7} {:>8} {:>9}  {:<16}  {:<12} {:>7} {:>8} {:>9} {:>6}\n",
      "ns per query", "found", "judge", "ours", "p99", "M/s", "right", "worst mm", "answers",
      "peer", "", "right", "worst mm", "ratio");
  for (const bench::QueryResult& result : bench.results) {
    const bench::QueryTimes& ours = result.engines.front();
    const double time = median_of(ours);
    fmt::print("{:<20} {:>6.2f} {:<9} {:>7.0f} {:>7.0f} {:>7.3f}", result.name, result.found,
               result.judge, time, bench::quantile(ours.times, 0.99), 1000 / time);
    print_agreement(ours.agreement);
    fmt::print("  {}", hash_text(result.hash));
    for (std::size_t i = 1; i < result.engines.size(); ++i)
      print_peer(result.engines[i], time);
    fmt::print("\n");
  }
  for (const std::string& peer : bench.absent)
    fmt::print("{}: absent\n", peer);
}

Json engine_of(const bench::QueryTimes& engine, double ours) {
  if (engine.times.empty()) return {{"engine", engine.engine}, {"ns", nullptr}};
  return {{"engine", engine.engine},
          {"ns", median_of(engine)},
          {"p99_ns", bench::quantile(engine.times, 0.99)},
          {"ratio", ours / median_of(engine)},
          {"right", engine.agreement.same},
          {"same_body", engine.agreement.same_body},
          {"worst_metres", engine.agreement.worst_metres}};
}

void print_json(const bench::QueryBench& bench) {
  Json json{{"bodies", bench.bodies},
            {"static_bodies", bench.static_bodies},
            {"world_hash", hash_text(bench.world_hash)},
            {"asserts", k_asserts},
            {"rows", Json::array()},
            {"absent", bench.absent}};
  for (const bench::QueryResult& result : bench.results) {
    Json row{{"query", result.name},
             {"found", result.found},
             {"answers_hash", hash_text(result.hash)},
             {"judge", result.judge},
             {"engines", Json::array()}};
    for (const bench::QueryTimes& engine : result.engines)
      row["engines"].push_back(engine_of(engine, median_of(result.engines.front())));
    json["rows"].push_back(std::move(row));
  }
  write_json(json);
}

int run(BenchQueriesOptions options) {
  if (options.quick) {
    options.measure.queries = 1024;
    options.measure.repeats = 5;
  }
  if (options.cpu) options.measure.clock = bench::thread_nanoseconds;
  const bench::QueryBench bench = bench::run_query_bench(options.measure);
  options.json ? print_json(bench) : print_table(bench);
  return k_ok;
}

}  // namespace

void add_bench_queries_command(CLI::App& bench, int& exit_code) {
  auto options = std::make_shared<BenchQueriesOptions>();
  bench::QueryOptions& measure = options->measure;
  CLI::App* command =
      bench.add_subcommand("queries", "Rays, casts, overlaps and points in a large still world");
  command->add_option("--world", measure.world, "The shapes of the bodies")
      ->transform(CLI::CheckedTransformer(k_worlds))
      ->option_text("primitives, hulls, or mesh: primitives about a terrain of 100,000 triangles");
  command->add_option("--bodies", measure.bodies, "In the world")
      ->capture_default_str()
      ->check(CLI::Range(16, 100'000));
  command->add_option("--queries", measure.queries, "Number of different queries in a row")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  command->add_option("--repeats", measure.repeats, "Timed repeats of each row")
      ->capture_default_str()
      ->check(CLI::Range(1, 10'000));
  command->add_option("--seed", measure.seed, "Seed of bodies and queries")->capture_default_str();
  add_broad_phase_option(*command, measure.broad_phase);
  command->add_flag("--cpu", options->cpu, "Count only the time that the thread itself ran");
  command->add_flag("--quick", options->quick, "1024 questions, 5 repeats");
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace lockstone::tool
