// A world of the core and one of the C interface to which the same is done.
#pragma once

#include <gtest/gtest.h>
#include <lockstone.h>

#include <lockstone/hull.h>
#include <lockstone/literals.h>
#include <lockstone/path.h>
#include <lockstone/world.h>

#include "tests/support/sample_assets.h"
#include "tools/bindings/c/convert.h"

namespace lockstone {

class TwinWorlds : public ::testing::Test {
 protected:
  TwinWorlds() {
    def_.body_capacity = 64;
    def_.tick_rate = 50;
    def_.substeps = 5;
    def_.sleep_ms = 700;
    def_.vehicle_capacity = 2;
    def_.terrain_tile_capacity = 3;
    def_.gravity = {{}, Acceleration::from_integer(-9), Acceleration::from_integer(1)};
  }

  void SetUp() override {
    using namespace lockstone::literals;
    EXPECT_EQ(lks_assets_create(&assets_), LKS_OK);
    std::vector<Vec3<Length>> points;
    std::vector<lks_length3> raw_points;
    for (int i = 0; i < 8; ++i) {
      const auto side = [&](int bit) { return Length::from_integer((i >> bit & 1) * 2 - 1); };
      points.push_back({side(0), side(1), side(2)});
      raw_points.push_back(c::raw_of(points.back()));
    }
    AssetPtr hull = Hull::build(points).hull;
    hull_ = hull->id();
    std::uint64_t id = 0;
    EXPECT_EQ(lks_assets_add_hull(assets_, raw_points.data(), raw_points.size(), 64, &id), LKS_OK);
    EXPECT_EQ(id, hull_.value);
    const AssetPtr field = test::sample_height_field();
    field_ = field->id();
    const std::vector<std::byte> bytes = field->canonical_bytes();
    EXPECT_EQ(lks_assets_add_bytes(assets_, bytes.data(), bytes.size(), &id), LKS_OK);
    EXPECT_EQ(id, field_.value);
    const std::vector<PathPoint> bend{{{}}, {{4_m, 1_m, 0_m}}, {{8_m, 1_m, 3_m}}};
    std::vector<lks_path_point> raw_bend;
    for (const PathPoint& point : bend)
      raw_bend.push_back({c::raw_of(point.position), c::raw_of(point.up)});
    const AssetPtr path = Path::build(bend, false).path;
    path_ = path->id();
    EXPECT_EQ(lks_assets_add_path(assets_, raw_bend.data(), raw_bend.size(), 0, &id), LKS_OK);
    EXPECT_EQ(id, path_.value);
    const std::vector<lks_angle> level(raw_bend.size());
    EXPECT_EQ(
        lks_assets_add_banked_path(assets_, raw_bend.data(), level.data(), level.size(), 0, &id),
        LKS_OK);
    EXPECT_EQ(id, path_.value);
    const AssetPtr panels = test::sample_panels();
    panels_ = panels->id();
    const std::vector<std::byte> panel_bytes = panels->canonical_bytes();
    EXPECT_EQ(lks_assets_add_bytes(assets_, panel_bytes.data(), panel_bytes.size(), &id), LKS_OK);
    world_.emplace(
        World::create(def_, std::make_shared<AssetSet>(std::vector{hull, field, path, panels}))
            .value());
    make_twin();
  }

  void TearDown() override {
    lks_world_destroy(twin_);
    lks_assets_destroy(assets_);
  }

  void expect_same_state(const char* after) {
    std::uint64_t hash = 0;
    EXPECT_EQ(lks_hash(twin_, &hash), LKS_OK);
    EXPECT_EQ(hash, world_->hash().total) << after;
  }

  void expect_same(Status core, lks_status c_status, const char* what) {
    EXPECT_EQ(static_cast<lks_status>(core), c_status) << what << ": " << lks_last_error();
    expect_same_state(what);
  }

  BodyHandle add(const BodyDef& def, const lks_body_def& raw) {
    const BodyHandle body = world_->create_body(def).value();
    lks_body id = 0;
    EXPECT_EQ(lks_create_body(twin_, &raw, &id), LKS_OK) << lks_last_error();
    EXPECT_EQ(id, c::id_of(body));
    expect_same_state("create body");
    return body;
  }

  BodyHandle add(MotionType motion, const Shape& shape, int x, int y) {
    BodyDef def{.motion = motion, .shape = shape};
    def.position = {Position::from_integer(x), Position::from_integer(y), {}};
    lks_body_def raw;
    EXPECT_EQ(lks_body_def_init(&raw, sizeof raw), LKS_OK);
    raw.motion = static_cast<std::uint32_t>(motion);
    raw.shape = c::raw_of(shape);
    raw.position = c::raw_of(def.position);
    return add(def, raw);
  }

  void step(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      const StepReport report = world_->step();
      lks_step_report raw{};
      raw.size = sizeof raw;
      EXPECT_EQ(lks_step(twin_, &raw), LKS_OK);
      EXPECT_EQ(raw.contacts, report.contacts);
      EXPECT_EQ(raw.moving_bodies, report.moving_bodies);
      expect_same_state("step");
    }
  }

  WorldDef def_;
  AssetId hull_;
  AssetId field_;
  AssetId path_;
  AssetId panels_;
  std::optional<World> world_;
  lks_world* twin_ = nullptr;
  lks_assets* assets_ = nullptr;

 private:
  void make_twin() {
    lks_world_def raw;
    EXPECT_EQ(lks_world_def_init(&raw, sizeof raw), LKS_OK);
    raw.body_capacity = def_.body_capacity;
    raw.tick_rate = def_.tick_rate;
    raw.substeps = def_.substeps;
    raw.sleep_ms = def_.sleep_ms;
    raw.vehicle_capacity = def_.vehicle_capacity;
    raw.terrain_tile_capacity = def_.terrain_tile_capacity;
    raw.gravity = c::raw_of(def_.gravity);
    EXPECT_EQ(lks_world_create(&raw, assets_, &twin_), LKS_OK) << lks_last_error();
    std::uint64_t hash = 0;
    EXPECT_EQ(lks_config_hash(&raw, assets_, &hash), LKS_OK);
    EXPECT_EQ(hash, config_hash(def_, world_->assets()->hash()));
    expect_same_state("create");
  }
};

/// A body of each kind of motion and of the usual shapes above a half space.
class TwinScene : public TwinWorlds {
 protected:
  void SetUp() override {
    using namespace lockstone::literals;
    TwinWorlds::SetUp();
    add(MotionType::static_body, Shape::half_space(), 0, 0);
    ball_ = add(MotionType::dynamic, Shape::sphere(1_m), 0, 3);
    box_ = add(MotionType::dynamic, Shape::box(1_m, 0.5_m, 2_m), 5, 3);
    add(MotionType::dynamic, Shape::capsule(1_m, 0.5_m), 10, 3);
    hull_body_ = add(MotionType::dynamic, {ShapeKind::hull, {}, hull_}, 15, 3);
    lift_ = add(MotionType::kinematic, Shape::box(1_m, 1_m, 1_m), 20, 3);
  }

  BodyHandle ball_, box_, hull_body_, lift_;
};

}  // namespace lockstone
