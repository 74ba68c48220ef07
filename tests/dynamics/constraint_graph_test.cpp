#include "core/dynamics/islands/constraint_graph.h"

#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace lockstone {
namespace {

using Place = ConstraintGraph::Place;

struct Constraint {
  std::uint32_t a, b;
};

bool operator==(const Place& x, const Place& y) {
  return x.color == y.color && x.rank == y.rank;
}

void add_bodies(ConstraintGraph& graph, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    graph.add_body();
}

ConstraintGraph color(const std::vector<Constraint>& constraints, std::size_t bodies) {
  ConstraintGraph graph(bodies, constraints.size());
  add_bodies(graph, bodies);
  for (const Constraint& c : constraints)
    graph.add(c.a, c.a != 0, c.b, c.b != 0);
  return graph;
}

std::vector<Constraint> random_constraints(std::uint32_t bodies, int count) {
  test::Random random;
  std::vector<Constraint> constraints;
  for (int i = 0; i < count; ++i) {
    const auto body = [&] { return static_cast<std::uint32_t>(random.between(0, bodies)); };
    const std::uint32_t a = body(), b = body();
    if (a != b) constraints.push_back({a, b});
  }
  return constraints;
}

TEST(ConstraintGraph, GivesNoBodyAColorTwice) {
  const std::vector<Constraint> constraints = random_constraints(200, 1500);
  const ConstraintGraph graph = color(constraints, 200);
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const std::uint32_t c = graph.places()[i].color;
    if (c == k_overflow_color) continue;
    for (const std::uint32_t body : {constraints[i].a, constraints[i].b}) {
      EXPECT_TRUE(body == 0 || seen.insert({c, body}).second) << "body " << body;
    }
  }
}

TEST(ConstraintGraph, RanksEachColorInTheOrderOfAdding) {
  const std::vector<Constraint> constraints = random_constraints(50, 400);
  const ConstraintGraph graph = color(constraints, 50);
  std::vector<std::uint32_t> next(k_graph_colors + 1);
  for (const Place& place : graph.places())
    EXPECT_EQ(place.rank, next[place.color]++);
  for (std::size_t c = 0; c <= k_graph_colors; ++c)
    EXPECT_EQ(graph.count(c), next[c]);
}

TEST(ConstraintGraph, RanksEachKindOfAColorByItselfAndTheOverflowInOneOrder) {
  const std::vector<Constraint> constraints = random_constraints(50, 1200);
  const ConstraintGraph plain = color(constraints, 50);
  ConstraintGraph graph(50, constraints.size());
  add_bodies(graph, 50);
  for (std::size_t i = 0; i < constraints.size(); ++i)
    graph.add(constraints[i].a, constraints[i].a != 0, constraints[i].b, constraints[i].b != 0,
              i % k_constraint_kinds);
  ASSERT_GT(graph.count(k_overflow_color), 1U);
  std::uint32_t next[k_graph_colors + 1][k_constraint_kinds] = {};
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const Place& place = graph.places()[i];
    EXPECT_EQ(place.color, plain.places()[i].color);
    EXPECT_EQ(place.kind, place.color == k_overflow_color ? 0 : i % k_constraint_kinds);
    EXPECT_EQ(place.rank, next[place.color][place.kind]++);
  }
  for (std::size_t c = 0; c <= k_graph_colors; ++c) {
    EXPECT_EQ(graph.count(c), plain.count(c));
    for (std::size_t kind = 0; kind < k_constraint_kinds; ++kind)
      EXPECT_EQ(graph.count(c, kind), next[c][kind]);
  }
}

TEST(ConstraintGraph, ForgetsEarlierConstraints) {
  const std::vector<Constraint> constraints = random_constraints(50, 300);
  const ConstraintGraph fresh = color(constraints, 50);
  ConstraintGraph used = color(random_constraints(50, 300), 50);
  used.clear();
  add_bodies(used, 50);
  for (const Constraint& c : constraints)
    used.add(c.a, c.a != 0, c.b, c.b != 0);
  ASSERT_EQ(used.places().size(), fresh.places().size());
  for (std::size_t i = 0; i < constraints.size(); ++i)
    EXPECT_TRUE(used.places()[i] == fresh.places()[i]);
}

TEST(ConstraintGraph, SharesBodiesThatNothingMoves) {
  ConstraintGraph graph(100, 200);
  add_bodies(graph, 100);
  for (std::uint32_t body = 1; body <= 99; ++body) {
    graph.add(body, true, 0, false);    // the ground
    graph.add(body, true, 100, false);  // a kinematic body
  }
  EXPECT_EQ(graph.colors(), 2U);
  EXPECT_EQ(graph.count(k_overflow_color), 0U);
}

TEST(ConstraintGraph, OverflowsWhereABodyHasMoreThanAllColors) {
  ConstraintGraph graph(100, 100);
  add_bodies(graph, 100);
  for (std::uint32_t body = 2; body <= 41; ++body)
    graph.add(1, true, body, true);
  EXPECT_EQ(graph.colors(), k_graph_colors);
  EXPECT_EQ(graph.count(k_overflow_color), 40 - k_graph_colors);
}

}  // namespace
}  // namespace lockstone
