// Asks every engine every row, and compares times and answers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/bench/queries/query_engine.h"
#include "tools/bench/support/measure.h"

namespace lockstone::bench {

struct QueryOptions {
  QueryWorld world = QueryWorld::primitives;
  std::uint32_t bodies = 4000;
  std::size_t queries = 4096;  ///< a row
  int repeats = 31;
  std::uint64_t seed = 1;
  BroadPhaseKind broad_phase = BroadPhaseKind::tree;
  Clock clock = now_nanoseconds;
};

/// How an engine's answers to a row compare with those of the judge.
struct Agreement {
  double same = 0;          ///< share of equal counts: hit or miss, how many bodies
  double same_body = 0;     ///< of those that name a body in both: the same one
  double worst_metres = 0;  ///< of these: largest difference of the two distances
};

/// One engine's times of one row, in nanoseconds a query, one a repeat. No times: no such question.
struct QueryTimes {
  std::string engine;
  std::vector<double> times;
  Agreement agreement;
};

struct QueryResult {
  std::string name;
  double found = 0;  ///< bodies per query, by our answers
  std::uint64_t hash = 0;
  std::string judge;                ///< "double"; ours where that has no answer
  std::vector<QueryTimes> engines;  ///< ours first
};

struct QueryBench {
  std::uint32_t bodies = 0;
  std::uint32_t static_bodies = 0;
  std::uint64_t world_hash = 0;
  std::vector<std::string> absent;  ///< peers
  std::vector<QueryResult> results;
};

/// The engines take turns within each repeat, so that a disturbance hits all of them alike.
[[nodiscard]] QueryBench run_query_bench(const QueryOptions& options);

}  // namespace lockstone::bench
