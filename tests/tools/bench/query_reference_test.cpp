// The judge of the query benchmark agrees with the world, and would notice if it were wrong.

#include <array>

#include <gtest/gtest.h>

#include <lockstone/literals.h>

#include "tools/bench/queries/query_engine.h"
#include "tools/bench/queries/query_scene.h"

namespace lockstone::bench {
namespace {

using namespace lockstone::literals;

std::vector<QueryAnswer> answers_of(QueryEngine& engine, const QueryRow& row) {
  std::vector<QueryAnswer> answers(row.size());
  EXPECT_TRUE(engine.answer(row, answers)) << row.name;
  return answers;
}

std::size_t differences(const QueryScene& judged, const World& world, const QueryRow& row) {
  const auto ours = answers_of(*make_lockstone_engine(world), row);
  const auto right = answers_of(*make_reference_engine(judged), row);
  std::size_t count = 0;
  for (std::size_t i = 0; i < ours.size(); ++i)
    count += ours[i].count != right[i].count || ours[i].body != right[i].body ? 1U : 0U;
  return count;
}

// Of shapes it knows the sphere.
bool is_unknown(const QueryRow& row) {
  return row.shape_asked() && row.shape.kind != ShapeKind::sphere;
}

TEST(QueryReference, AgreesWithTheWorld) {
  const QueryScene scene = make_query_scene(QueryWorld::primitives, 200, 3);
  const World world = make_query_world(scene);
  int rows = 0;
  for (const QueryRow& row : make_query_rows(scene, world, 300, 3)) {
    if (is_unknown(row)) continue;
    EXPECT_EQ(differences(scene, world, row), 0U) << row.name;
    ++rows;
  }
  EXPECT_GT(rows, 0);
}

TEST(QueryReference, AgreesAboutRaysAtATerrain) {
  const QueryScene scene = make_query_scene(QueryWorld::mesh, 50, 3);
  const World world = make_query_world(scene);
  int rows = 0;
  for (const QueryRow& row : make_query_rows(scene, world, 20, 3)) {
    std::vector<QueryAnswer> answers(row.size());
    if (!make_reference_engine(scene)->answer(row, answers)) continue;
    ++rows;
    EXPECT_EQ(differences(scene, world, row), 0U) << row.name;
  }
  EXPECT_EQ(rows, 6);
}

TEST(QueryReference, NoticesBodiesThatAreElsewhere) {
  const QueryScene scene = make_query_scene(QueryWorld::primitives, 200, 3);
  const World world = make_query_world(scene);
  QueryScene moved = scene;
  for (QueryBody& body : moved.bodies)
    body.pose.position.y += 0.3_m;
  for (const QueryRow& row : make_query_rows(scene, world, 300, 3)) {
    if (is_unknown(row)) continue;
    EXPECT_GT(differences(moved, world, row), 0U) << row.name;
  }
}

TEST(QueryReference, RefusesUnknownShapes) {
  const QueryRow box{"box", QueryKind::overlap, {}, Shape::box(1_m, 1_m, 1_m), {Transform{}}, {}};
  std::array<QueryAnswer, 1> answers{};
  const QueryScene plain = make_query_scene(QueryWorld::primitives, 16, 1);
  EXPECT_FALSE(make_reference_engine(plain)->answer(box, answers));
  const QueryRow ray{"ray", QueryKind::closest_ray, {Ray{{}, {1_m, {}, {}}}}, {}, {}, {}};
  EXPECT_TRUE(make_reference_engine(plain)->answer(ray, answers));
  const QueryScene hulls = make_query_scene(QueryWorld::hulls, 16, 1);
  EXPECT_FALSE(make_reference_engine(hulls)->answer(ray, answers));
}

}  // namespace
}  // namespace lockstone::bench
