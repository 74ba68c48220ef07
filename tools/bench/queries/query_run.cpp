#include "tools/bench/queries/query_run.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <lockstone/testing/floating.h>

#include "tools/bench/peers/peers.h"

namespace lockstone::bench {
namespace {

using Engines = std::vector<std::unique_ptr<QueryEngine>>;
using Answers = std::vector<QueryAnswer>;

double length_of(const Ray& ray) {
  return std::hypot(testing::to_double(ray.translation.x), testing::to_double(ray.translation.y),
                    testing::to_double(ray.translation.z));
}

Agreement compare(const QueryRow& row, const Answers& judge, const Answers& theirs) {
  std::size_t same = 0, both = 0, same_body = 0;
  Agreement agreement;
  for (std::size_t i = 0; i < judge.size(); ++i) {
    same += judge[i].count == theirs[i].count ? 1U : 0U;
    if (judge[i].body == k_no_body || theirs[i].body == k_no_body) continue;
    ++both;
    if (judge[i].body != theirs[i].body) continue;
    ++same_body;
    const double unit = row.names_fraction() ? length_of(row.rays[i]) : 1;
    const double apart = std::abs(judge[i].where - theirs[i].where) * unit;
    agreement.worst_metres = std::max(agreement.worst_metres, apart);
  }
  agreement.same = static_cast<double>(same) / static_cast<double>(judge.size());
  if (both != 0) agreement.same_body = static_cast<double>(same_body) / static_cast<double>(both);
  return agreement;
}

double found_per_query(const Answers& answers) {
  double sum = 0;
  for (const QueryAnswer& answer : answers)
    sum += answer.count;
  return sum / static_cast<double>(answers.size());
}

// ns a query; negative when the engine has no answer.
double time_row(QueryEngine& engine, const QueryRow& row, Clock clock, Answers& answers) {
  const std::uint64_t begin = clock();
  if (!engine.answer(row, answers)) return -1;
  const auto time = static_cast<double>(clock() - begin);
  return time / static_cast<double>(row.size());
}

void time_engines(const QueryRow& row, const Engines& engines, const QueryOptions& options,
                  std::vector<Answers>& answers, QueryResult& result) {
  for (int repeat = -1; repeat < options.repeats; ++repeat) {  // the first is to warm up
    for (std::size_t i = 0; i < engines.size(); ++i) {
      const double time = time_row(*engines[i], row, options.clock, answers[i]);
      if (repeat >= 0 && time >= 0) result.engines[i].times.push_back(time);
    }
  }
}

QueryResult run_row(const QueryRow& row, const Engines& engines, QueryEngine* reference,
                    const QueryOptions& options) {
  QueryResult result;
  result.name = row.name;
  std::vector<Answers> answers(engines.size(), Answers(row.size()));
  for (const auto& engine : engines)
    result.engines.push_back({engine->name(), {}, {}});
  time_engines(row, engines, options, answers, result);
  result.found = found_per_query(answers.front());
  Answers right(row.size());
  const bool judged = reference != nullptr && reference->answer(row, right);
  result.judge = judged ? reference->name() : engines.front()->name();
  for (std::size_t i = 0; i < engines.size(); ++i)
    result.engines[i].agreement = compare(row, judged ? right : answers.front(), answers[i]);
  return result;
}

// Ours first; a peer that is not there is named in `absent`.
Engines make_engines(const QueryScene& scene, const World& world,
                     std::vector<std::string>& absent) {
  Engines engines;
  engines.push_back(make_lockstone_engine(world));
  for (const PeerMaker& peer : peer_makers()) {
    std::unique_ptr<QueryEngine> engine = peer.make(scene);
    if (engine == nullptr)
      absent.emplace_back(peer.name);
    else
      engines.push_back(std::move(engine));
  }
  return engines;
}

}  // namespace

QueryBench run_query_bench(const QueryOptions& options) {
  const QueryScene scene = make_query_scene(options.world, options.bodies, options.seed);
  const World world = make_query_world(scene, options.broad_phase);
  QueryBench bench;
  bench.bodies = options.bodies;
  bench.static_bodies = static_cast<std::uint32_t>(
      std::ranges::count_if(scene.bodies, [](const QueryBody& body) { return body.is_static; }));
  bench.world_hash = world.hash().total;
  const Engines engines = make_engines(scene, world, bench.absent);
  const std::unique_ptr<QueryEngine> reference = make_reference_engine(scene);
  for (const QueryRow& row : make_query_rows(scene, world, options.queries, options.seed)) {
    bench.results.push_back(run_row(row, engines, reference.get(), options));
    bench.results.back().hash = hash_of_answers(world, row);
  }
  return bench;
}

}  // namespace lockstone::bench
