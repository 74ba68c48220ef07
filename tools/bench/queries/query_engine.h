// The engines that `lockstone bench queries` asks: ours, and peers beside it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "tools/bench/queries/query_scene.h"

namespace lockstone::bench {

inline constexpr std::uint32_t k_no_body = 0xffffffff;

/// All kinds fill `count`, 1 or 0 where one body is asked for. A closest ray, a closest cast and a
/// near point name the `body`, and `where`: a fraction of the way, or metres from the point.
struct QueryAnswer {
  std::uint32_t count = 0;
  std::uint32_t body = k_no_body;
  double where = 1;
};

class QueryEngine {
 public:
  virtual ~QueryEngine() = default;

  [[nodiscard]] virtual std::string name() const = 0;

  /// Runs all queries of a row; false when the engine has no such query.
  virtual bool answer(const QueryRow& row, std::span<QueryAnswer> out) = 0;
};

/// Refers to the world for its life.
[[nodiscard]] std::unique_ptr<QueryEngine> make_lockstone_engine(const World& world);

/// Judges the others: in double, one body after the other. Knows of shapes that overlap or are cast
/// the sphere alone, and where there are hulls or a mesh, rays alone.
[[nodiscard]] std::unique_ptr<QueryEngine> make_reference_engine(const QueryScene& scene);

/// Of everything that our answers to a row say, normals and points included.
[[nodiscard]] std::uint64_t hash_of_answers(const World& world, const QueryRow& row);

}  // namespace lockstone::bench
