// Pictures are well formed, and drawing changes nothing.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "tools/render/svg.h"
#include "tools/scenes/play.h"

namespace lockstone::render {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at)
    ++found;
  return found;
}

TEST(Render, DrawsEveryBodyOfTheStack) {
  const auto play = scenes::make_play("stack", 1).value();
  const std::string svg = draw(play->world(), {.caption = "a caption"});
  EXPECT_EQ(svg.rfind("</svg>\n"), svg.size() - 7);
  EXPECT_EQ(count(svg, "<svg"), count(svg, "</svg>"));
  EXPECT_EQ(count(svg, "<polygon points='"), 11U * 3 + 10);  // three faces each, and shadows
  EXPECT_EQ(count(svg, "a caption"), 1U);
  EXPECT_EQ(count(svg, "nan"), 0U);
}

TEST(Render, ChangesNothing) {
  const auto play = scenes::make_play("arena", 1).value();
  for (int tick = 0; tick < 20; ++tick)
    play->step();
  const std::uint64_t hash = play->simulation().hash();
  EXPECT_EQ(draw(play->world(), {.style = arena_look}), draw(play->world(), {.style = arena_look}));
  EXPECT_EQ(play->simulation().hash(), hash);
}

TEST(Render, DrawsEveryShapeThereIs) {
  for (const char* scene : {"hulls", "compounds", "terrain", "mesh", "bullets", "layers"}) {
    const auto play = scenes::make_play(scene, 1).value();
    play->step();
    const std::string svg = draw(play->world(), {});
    EXPECT_EQ(count(svg, "<svg"), count(svg, "</svg>")) << scene;
    EXPECT_EQ(count(svg, "<g "), count(svg, "</g>")) << scene;
    EXPECT_EQ(count(svg, "nan") + count(svg, "inf"), 0U) << scene;
  }
}

// Of a height field every triangle without holes is one polygon; besides, there are shadows and
// bodies.
TEST(Render, DrawsEveryTriangleOfATerrain) {
  const auto play = scenes::make_play("terrain", 1).value();
  EXPECT_GE(count(draw(play->world(), {}), "<polygon"), 2U * (32 * 32 - 9 - 6));
}

Solid box_at(double x, double y, double z, double half) {
  Solid solid;
  solid.kind = ShapeKind::box;
  solid.center = {x, y, z};
  solid.axes = {Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, 1}};
  solid.size = {half, half, half};
  return solid;
}

TEST(Render, PaintsTheGroundBeforeBodiesOnItAndAfterBodiesBelowIt) {
  Solid ground = box_at(0, -1, 0, 1);
  ground.size = {20, 1, 20};
  const std::vector<Solid> solids{box_at(-15, 0.5, -15, 0.5), ground, box_at(15, 0.5, 15, 0.5),
                                  box_at(0, -4, 0, 0.5)};
  const std::vector<std::size_t> order = paint_order(solids, Camera({}, 0.5, 0.5));
  const auto turn = [&](std::size_t solid) {
    return std::find(order.begin(), order.end(), solid) - order.begin();
  };
  EXPECT_LT(turn(1), turn(0));
  EXPECT_LT(turn(1), turn(2));
  EXPECT_LT(turn(3), turn(1));
}

TEST(Render, PaintsATriangleBeforeBodiesOnItAndAfterBodiesBelowIt) {
  Solid triangle;
  triangle.kind = ShapeKind::mesh;
  triangle.facets = {{{0, 1, 0}, {{-5, 0, -5}, {0, 0, 5}, {5, 0, -5}}}};
  const std::vector<Solid> solids{box_at(0, 0.5, 0, 0.5), triangle, box_at(0, -2, 0, 0.5)};
  EXPECT_EQ(paint_order(solids, Camera({}, 0.5, 0.5)), (std::vector<std::size_t>{2, 1, 0}));
}

TEST(Render, OutlinesABallAsACircle) {
  Solid ball = box_at(3, 2, 1, 0.5);
  ball.kind = ShapeKind::sphere;
  const std::vector<Vec> outline = outline_from_above(ball);
  EXPECT_EQ(outline.size(), 20U);
  for (const Vec& point : outline)
    EXPECT_NEAR(std::hypot(point.x - 3, point.z - 1), 0.5, 1e-9);
}

}  // namespace
}  // namespace lockstone::render
