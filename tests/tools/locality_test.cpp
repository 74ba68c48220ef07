// Law 9: an island's result does not depend on other islands. Every scene takes the same course
// alone and beside every other scene, to the bit (docs/explanation/locality.md).
#include <algorithm>
#include <cstdlib>
#include <initializer_list>
#include <memory>
#include <optional>
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

// Their commands may go to any body of the world, those of other scenes included.
constexpr std::string_view k_drive_everything[] = {"commands", "belts"};

enum class Order { first, last };

// A world with room for all these scenes. All else is the first one's, also the capacity of islands
// that are solved to convergence if none is given.
World make_world(std::span<const Scene* const> scenes,
                 std::optional<std::uint32_t> converged_contacts = {}) {
  WorldDef def = scenes.front()->define();
  std::vector<AssetPtr> assets;
  for (const Scene* scene : scenes) {
    if (scene != scenes.front()) {
      const WorldDef more = scene->define();
      def.body_capacity += more.body_capacity;
      def.pair_capacity += more.pair_capacity;
      def.contact_capacity += more.contact_capacity;
      def.joint_capacity += more.joint_capacity;
      def.vehicle_capacity += more.vehicle_capacity;
      def.terrain_tile_capacity += more.terrain_tile_capacity;
    }
    if (scene->assets == nullptr) continue;
    for (const AssetPtr& asset : scene->assets(k_seed))
      assets.push_back(asset);
  }
  def.vehicle_capacity = std::min(def.vehicle_capacity, k_max_vehicles);
  def.converged_contacts = converged_contacts.value_or(def.converged_contacts);
  return World::create(def, std::make_shared<const AssetSet>(std::move(assets))).value();
}

World make_world(std::initializer_list<const Scene*> scenes) {
  return make_world(std::span<const Scene* const>(scenes.begin(), scenes.size()));
}

// Returns the scene's bodies.
std::vector<BodyHandle> build(const Scene& scene, World& world) {
  const std::uint32_t begin = world.body_limit();
  scene.build(world, k_seed);
  std::vector<BodyHandle> bodies;
  for (std::uint32_t i = begin; i < world.body_limit(); ++i)
    bodies.push_back(world.body_at(i));
  return bodies;
}

std::vector<BodyHandle> build_at(const Scene& scene, World& world, const Vec3<Position>& place) {
  std::vector<BodyHandle> bodies = build(scene, world);
  for (const BodyHandle body : bodies) {
    const BodyView view = world.body(body);
    order(world, Teleport{body, view.position + place, view.orientation});
  }
  return bodies;
}

// A scene in a world, perhaps beside another one.
class Company {
 public:
  Company(const Scene& scene, const Scene* other, Order order)
      : scene_(scene),
        is_driven_(order == Order::first && std::ranges::find(k_drive_everything, scene.name) ==
                                                std::end(k_drive_everything)),
        world_(other == nullptr ? make_world({&scene}) : make_world({&scene, other})) {
    if (other != nullptr && order == Order::last) build_at(*other, world_, k_elsewhere);
    bodies_ = build(scene, world_);
    if (other != nullptr && order == Order::first) build_at(*other, world_, k_elsewhere);
  }

  void step() {
    // Later a body that a scene pushes may have left the world.
    const bool is_in_time = world_.tick() < scene_.golden_ticks;
    if (is_driven_ && is_in_time && scene_.drive != nullptr) scene_.drive(world_, k_seed);
    (void)world_.step();
    if (is_driven_ && scene_.observe != nullptr) scene_.observe(world_);
  }

  [[nodiscard]] std::size_t count() const { return bodies_.size(); }
  [[nodiscard]] bool has(std::size_t i) const { return world_.exists(bodies_[i]); }
  [[nodiscard]] BodyView body(std::size_t i) const { return world_.body(bodies_[i]); }

 private:
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
  World world = make_world({&scene});
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

// LOCKSTONE_LOCALITY_TICKS=2000 plays all pairs for this many ticks: some hours. Each of two scenes
// is compared: the one that is built first, and the one that is built last.
std::uint32_t all_pairs_ticks() {
  const char* ticks = std::getenv("LOCKSTONE_LOCALITY_TICKS");
  return ticks == nullptr ? 0 : static_cast<std::uint32_t>(std::stoul(ticks));
}

class EverySceneBesideOthers : public ::testing::TestWithParam<std::string> {};

// The first scene with an end from this place in the list on.
const Scene* next_with_an_end(std::size_t at) {
  const std::span<const Scene> all = world_scenes();
  while (!has_an_end(all[at % all.size()]))
    ++at;
  return &all[at % all.size()];
}

TEST_P(EverySceneBesideOthers, GoesTheWayItGoesAlone) {
  const Scene& scene = *find_scene(GetParam());
  if (const std::uint32_t ticks = all_pairs_ticks(); ticks != 0) {
    const std::vector<const Scene*> all = scenes_with_an_end();
    std::vector<const Scene*> before, after;
    for (const Scene* other : all)
      if (other != &scene) (other < &scene ? before : after).push_back(other);
    EXPECT_NO_FATAL_FAILURE(expect_alike(scene, after, Order::first, ticks));
    EXPECT_NO_FATAL_FAILURE(expect_alike(scene, before, Order::last, ticks));
    return;
  }
  const auto at = static_cast<std::size_t>(&scene - world_scenes().data());
  std::vector<const Scene*> others;
  for (const std::size_t distance : k_neighbours)
    others.push_back(next_with_an_end(at + distance));
  EXPECT_NO_FATAL_FAILURE(expect_alike(scene, others, Order::first, k_ticks));
  EXPECT_NO_FATAL_FAILURE(expect_alike(scene, others, Order::last, k_ticks));
}

INSTANTIATE_TEST_SUITE_P(Scenes, EverySceneBesideOthers,
                         ::testing::ValuesIn(test::share_of_cases(names())), test::parameter_name);

// A scene that is built at a place, and a hash of its bodies, seen from that place, of each tick.
struct Member {
  const Scene* scene;
  Vec3<Position> place;
  std::vector<BodyHandle> bodies;
  std::vector<std::uint64_t> course;
};

std::uint64_t hash_of(const World& world, const Member& member) {
  std::vector<std::int64_t> values;
  const auto add_vector = [&](const auto& v) {
    for (const auto& x : {v.x, v.y, v.z})
      values.push_back(x.raw);
  };
  for (const BodyHandle body : member.bodies) {
    values.push_back(world.exists(body));
    if (values.back() == 0) continue;
    const BodyView view = world.body(body);
    add_vector(view.position - member.place);
    add_vector(view.velocity);
    add_vector(view.angular_velocity);
    for (const auto& x :
         {view.orientation.w, view.orientation.x, view.orientation.y, view.orientation.z})
      values.push_back(x.raw);
    values.push_back(view.is_asleep);
  }
  return hash64(std::as_bytes(std::span(values)));
}

void play(World& world, std::span<Member> members, std::uint32_t ticks) {
  for (std::uint32_t tick = 0; tick < ticks; ++tick) {
    (void)world.step();
    for (Member& member : members)
      member.course.push_back(hash_of(world, member));
  }
}

constexpr std::size_t k_places = 49;

// Scene i of a square of places, far apart and around the middle of the world.
Vec3<Position> place_of(std::size_t i) {
  const auto along = [](std::size_t at) {
    return Position::from_integer(static_cast<std::int32_t>(at) * 50000 - 150000);
  };
  return {along(i % 7), {}, along(i / 7)};
}

// Plays all scenes in one world, and each, or one of `stride`, alone in a world with the same room.
// Returns the names of the scenes whose courses differ, with the first tick.
std::vector<std::string> changed_by_others(std::span<const Scene* const> all,
                                           std::uint32_t converged_contacts, std::uint32_t ticks,
                                           std::size_t stride = 1) {
  World crowd = make_world(all, converged_contacts);
  std::vector<Member> members;
  for (std::size_t i = 0; i < all.size(); ++i)
    members.push_back({all[i], place_of(i), build_at(*all[i], crowd, place_of(i)), {}});
  play(crowd, members, ticks);

  std::vector<std::string> changed;
  for (std::size_t i = 0; i < members.size(); i += stride) {
    const Member& member = members[i];
    World world = make_world(all, converged_contacts);
    Member alone{member.scene, k_elsewhere, build_at(*member.scene, world, k_elsewhere), {}};
    play(world, {&alone, 1}, ticks);
    const auto [here, there] = std::ranges::mismatch(alone.course, member.course);
    if (here != alone.course.end())
      changed.push_back(std::string(member.scene->name) + ", tick " +
                        std::to_string(here - alone.course.begin() + 1));
  }
  return changed;
}

// All pairs at once: a scene that any of the others changes takes another course.
TEST(Locality, LetsAllScenesOfOneWorldGoTheWayTheyGoAlone) {
  const std::vector<const Scene*> all = scenes_with_an_end();
  ASSERT_LE(all.size(), k_places);
  const std::uint32_t ticks = all_pairs_ticks() == 0 ? k_ticks : all_pairs_ticks();
  constexpr std::size_t k_stride = LKS_SANITIZED ? 4 : 1;
  EXPECT_EQ(changed_by_others(all, 1U << 13, ticks, k_stride), std::vector<std::string>{});
}

// A negative control: islands share this capacity, and docs/explanation/locality.md says so.
TEST(Locality, IsBrokenByACapacityThatIsTooSmall) {
  const std::vector<const Scene*> all = scenes_with_an_end();
  ASSERT_GE(all.size(), 24U);
  EXPECT_NE(changed_by_others(std::span(all).first(24), 64, 20), std::vector<std::string>{});
}

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
