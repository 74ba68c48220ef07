// Law 9: an island's result does not depend on other islands. Every scene takes the same course
// alone and beside every other scene, to the bit (docs/explanation/locality.md).
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/literals.h>
#include <lockstone/world.h>

#include "tests/support/parameter_name.h"
#include "tests/support/workload.h"
#include "tools/scenes/build.h"
#include "tools/scenes/scene.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

constexpr std::uint64_t k_seed = 1;
constexpr std::uint32_t k_ticks = test::share_of(100);

// Distances in the list of scenes between a scene and the ones beside which it is played.
constexpr std::size_t k_neighbours[] = {1, 7};

// Where the other scene is built: farther away than any scene is wide.
constexpr Vec3<Position> k_elsewhere{30000_m, {}, 20000_m};

// Its commands go to any body of the world, those of other scenes included.
constexpr std::string_view k_drives_everything = "commands";

enum class Order { first, last };

// A scene in a world, perhaps beside another one.
class Company {
 public:
  Company(const Scene& scene, const Scene* other, Order order)
      : scene_(scene),
        is_driven_(order == Order::first && scene.name != k_drives_everything),
        world_(make_world(scene, other)) {
    if (other != nullptr && order == Order::last) add_other(*other);
    const std::uint32_t begin = world_.body_limit();
    scene.build(world_, k_seed);
    for (std::uint32_t i = begin; i < world_.body_limit(); ++i)
      bodies_.push_back(world_.body_at(i));
    if (other != nullptr && order == Order::first) add_other(*other);
  }

  void step() {
    // Later a body that a scene pushes may have left the world.
    const bool is_in_time = world_.tick() < scene_.golden_ticks;
    if (is_driven_ && is_in_time && scene_.drive != nullptr) scene_.drive(world_, k_seed);
    (void)world_.step();
    if (is_driven_ && scene_.observe != nullptr) scene_.observe(world_);
  }

  static World make_world(const Scene& scene, const Scene* other) {
    WorldDef def = scene.define();
    std::vector<AssetPtr> assets;
    const auto add_assets = [&](const Scene& from) {
      if (from.assets == nullptr) return;
      for (const AssetPtr& asset : from.assets(k_seed))
        assets.push_back(asset);
    };
    add_assets(scene);
    if (other != nullptr) {
      const WorldDef more = other->define();
      def.body_capacity += more.body_capacity;
      def.pair_capacity += more.pair_capacity;
      def.contact_capacity += more.contact_capacity;
      def.joint_capacity += more.joint_capacity;
      def.vehicle_capacity += more.vehicle_capacity;
      def.terrain_tile_capacity += more.terrain_tile_capacity;
      add_assets(*other);
    }
    return World::create(def, std::make_shared<const AssetSet>(std::move(assets))).value();
  }

  [[nodiscard]] std::size_t count() const { return bodies_.size(); }
  [[nodiscard]] bool has(std::size_t i) const { return world_.exists(bodies_[i]); }
  [[nodiscard]] BodyView body(std::size_t i) const { return world_.body(bodies_[i]); }

 private:
  void add_other(const Scene& other) {
    const std::uint32_t begin = world_.body_limit();
    other.build(world_, k_seed);
    for (std::uint32_t i = begin; i < world_.body_limit(); ++i) {
      const BodyHandle body = world_.body_at(i);
      const BodyView view = world_.body(body);
      order(world_, Teleport{body, view.position + k_elsewhere, view.orientation});
    }
  }

  const Scene& scene_;
  bool is_driven_;
  World world_;
  std::vector<BodyHandle> bodies_;
};

void expect_same(const BodyView& alone, const BodyView& beside) {
  ASSERT_EQ(alone.position, beside.position);
  ASSERT_EQ(alone.orientation, beside.orientation);
  ASSERT_EQ(alone.velocity, beside.velocity);
  ASSERT_EQ(alone.angular_velocity, beside.angular_velocity);
  ASSERT_EQ(alone.is_asleep, beside.is_asleep);
}

void expect_same_bodies(const Company& alone, const Company& beside) {
  for (std::size_t i = 0; i < alone.count(); ++i) {
    ASSERT_EQ(alone.has(i), beside.has(i)) << "body " << i;
    if (!alone.has(i)) continue;
    ASSERT_NO_FATAL_FAILURE(expect_same(alone.body(i), beside.body(i))) << "body " << i;
  }
}

// The others' companies are stepped side by side: the scene alone is played once.
void expect_alike(const Scene& scene, std::span<const Scene* const> others, Order order,
                  std::uint32_t ticks) {
  Company alone(scene, nullptr, order);
  std::vector<Company> companies;
  for (const Scene* other : others)
    companies.emplace_back(scene, other, order);
  for (const Company& beside : companies)
    ASSERT_EQ(alone.count(), beside.count());
  for (std::uint32_t tick = 0; tick < ticks; ++tick) {
    alone.step();
    for (std::size_t which = 0; which < companies.size(); ++which) {
      companies[which].step();
      ASSERT_NO_FATAL_FAILURE(expect_same_bodies(alone, companies[which]))
          << scene.name << " beside " << others[which]->name << ", tick " << tick;
    }
  }
}

// A half-space has no end: it meets everything.
bool has_an_end(const Scene& scene) {
  World world = Company::make_world(scene, nullptr);
  scene.build(world, k_seed);
  for (std::uint32_t i = 0; i < world.body_limit(); ++i)
    if (world.body(world.body_at(i)).shape.kind == ShapeKind::half_space) return false;
  return true;
}

std::vector<const Scene*> scenes_with_an_end() {
  std::vector<const Scene*> result;
  for (const Scene& scene : world_scenes())
    if (has_an_end(scene)) result.push_back(&scene);
  return result;
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const Scene& scene : world_scenes())
    result.emplace_back(scene.name);
  return result;
}

// LOCKSTONE_LOCALITY_TICKS=2000 plays all pairs for this many ticks: about an hour. Each of two
// scenes is compared: the one that is built first, and the one that is built last.
std::uint32_t all_pairs_ticks() {
  const char* ticks = std::getenv("LOCKSTONE_LOCALITY_TICKS");
  return ticks == nullptr ? 0 : static_cast<std::uint32_t>(std::stoul(ticks));
}

class EverySceneBesideOthers : public ::testing::TestWithParam<std::string> {};

TEST_P(EverySceneBesideOthers, GoesTheWayItGoesAlone) {
  static const std::vector<const Scene*> all = scenes_with_an_end();
  const Scene& scene = *find_scene(GetParam());
  if (const std::uint32_t ticks = all_pairs_ticks(); ticks != 0) {
    const auto later =
        std::find_if(all.begin(), all.end(), [&](const Scene* other) { return other >= &scene; });
    EXPECT_NO_FATAL_FAILURE(expect_alike(scene, {later, all.end()}, Order::first, ticks));
    EXPECT_NO_FATAL_FAILURE(expect_alike(scene, {all.begin(), later}, Order::last, ticks));
    return;
  }
  const auto at = static_cast<std::size_t>(&scene - world_scenes().data());
  std::vector<const Scene*> others;
  for (const std::size_t distance : k_neighbours)
    others.push_back(all[(at + distance) % all.size()]);
  EXPECT_NO_FATAL_FAILURE(expect_alike(scene, others, Order::first, k_ticks));
  EXPECT_NO_FATAL_FAILURE(expect_alike(scene, others, Order::last, k_ticks));
}

INSTANTIATE_TEST_SUITE_P(Scenes, EverySceneBesideOthers, ::testing::ValuesIn(names()),
                         test::parameter_name);

// Fourteen stacks have 168 contacts, more than one island may have to be solved directly.
TEST(Locality, LetsFourteenStacksStandAsOneStands) {
  const auto tops = [](int stacks) {
    World world = World::create(small_world()).value();
    add_ground(world, 100_m);
    std::vector<BodyHandle> bodies;
    for (int level = 0; level < 12; ++level) {
      for (int i = 0; i < stacks; ++i) {
        // Each level is off by up to 3 cm, alike in all stacks.
        const std::int32_t aside_mm = level * 37 % 61 - 30;
        bodies.push_back(add(
            world, loose(Shape::box(0.25_m, 0.25_m, 0.25_m),
                         {millimetres(i * 3000 + aside_mm), millimetres(250 + level * 500), {}})));
      }
    }
    for (std::uint32_t tick = 0; tick < test::share_of(600U); ++tick)
      (void)world.step();
    return world.position(bodies[static_cast<std::size_t>(11 * stacks)]);
  };
  const Vec3<Position> alone = tops(1);
  EXPECT_GT(alone.y, 5.74_m);
  EXPECT_EQ(tops(14), alone);
}

}  // namespace
}  // namespace lockstone::scenes
