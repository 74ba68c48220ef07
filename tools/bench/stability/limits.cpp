// Values at every limit, shapes that are hardly any, and a world that is saved and loaded each
// tick.
#include <array>

#include <lockstone/hull.h>
#include <lockstone/literals.h>
#include <lockstone/mesh.h>
#include <lockstone/testing/floating.h>

#include "tools/arena/integers.h"
#include "tools/bench/stability/stability_scene.h"

namespace lockstone::bench {
namespace {

using namespace literals;

// m, how far the worst centre is outside the world.
double most_outside(const World& world) {
  double most = 0;
  for_bodies(world, [&](const BodyView& body) {
    for (int i = 0; i < 3; ++i)
      most = std::max(most, testing::to_double(abs(body.position[i]) - k_world_limit));
  });
  return most;
}

// m/s along an axis, which the limit bounds.
double greatest_axis_speed(const World& world) {
  double most = 0;
  for_bodies(world, [&](const BodyView& body) {
    for (int i = 0; i < 3; ++i)
      most = std::max(most, std::abs(testing::to_double(body.velocity[i])));
  });
  return most;
}

// As much as a command can say, of one sign in each axis by the bits of a number.
template <class T>
Vec3<T> utmost(std::uint32_t bits) {
  const auto one = [&](std::uint32_t bit) { return (bits >> bit & 1) != 0 ? T::max() : T::min(); };
  return {one(0), one(1), one(2)};
}

void push_to_the_limit(World& world, BodyHandle body, std::uint32_t bits) {
  switch (bits % 7) {
    case 0:
      (void)world.apply(ApplyForce{body, utmost<Force>(bits)});
      break;
    case 1:
      (void)world.apply(ApplyTorque{body, utmost<Torque>(bits)});
      break;
    case 2:
      (void)world.apply(ApplyImpulse{body, utmost<Impulse>(bits)});
      break;
    case 3:
      (void)world.apply(ApplyAngularImpulse{body, utmost<AngularImpulse>(bits)});
      break;
    case 4:
      (void)world.apply(SetVelocity{body, utmost<Velocity>(bits)});
      break;
    case 5:
      (void)world.apply(SetAngularVelocity{body, utmost<AngularVelocity>(bits)});
      break;
    default:
      (void)world.apply(SetGravity{utmost<Acceleration>(bits)});
      break;
  }
}

// The lightest and the heaviest bodies, about a pit's middle, pushed by all that the types hold.
StabilityResult saturation(double seconds) {
  SceneRun scene(k_usual_setting, contact_world());
  scene.add(ground());
  std::vector<BodyHandle> bodies;
  for (int i = 0; i < 12; ++i) {
    BodyDef body = body_at(i % 2 == 0 ? unit_box() : Shape::sphere(0.01_m), 1.5 * i - 9, 2, 0);
    body.material.density = Density::from_integer(i % 4 < 2 ? 100'000 : 1);
    bodies.push_back(scene.add(body));
  }
  arena::Random random(1);
  const auto push = [&](const World&) {
    const auto at = static_cast<std::size_t>(random.between(0, 11));
    push_to_the_limit(scene.world(), bodies[at],
                      static_cast<std::uint32_t>(random.between(0, 1 << 20)));
    return 0.0;
  };
  const auto [speed, outside, norm, pushed] =
      worst_of(scene, seconds, greatest_axis_speed, most_outside, worst_norm, push);
  return stability_of(scene, {{"greatest speed along an axis", "m/s", speed, 500.001},
                              {"outside the world", "m", outside + pushed, 0},
                              {"quaternion's length off 1", "", norm, 1e-8}});
}

// Points of a flake: of any thinness, some on a line, some twice.
std::vector<Vec3<Length>> flake(arena::Random& random) {
  const int thickness_um = 1 << random.between(0, 16), width_um = 1 << random.between(10, 20);
  std::vector<Vec3<Length>> points;
  const auto within = [&](int extent_um) {
    return Length::from_ratio(random.between(-extent_um, extent_um), 2'000'000);
  };
  for (int i = random.between(4, 12); i > 0; --i) {
    points.push_back({within(1 << 20), within(thickness_um), within(width_um)});
    if (random.between(0, 3) == 0) points.push_back(points.back());
  }
  return points;
}

// A floor of triangles as they come out of tools: some without area, some twice, long slivers.
AssetPtr worn_floor(arena::Random& random) {
  constexpr std::uint32_t k_side = 17;
  std::vector<Vec3<Length>> vertices;
  std::vector<TriangleIndices> triangles;
  for (std::uint32_t i = 0; i < k_side * k_side; ++i) {
    const auto at = [](std::uint32_t n) { return Length::from_ratio(static_cast<int>(n) - 8, 1); };
    const Length bend = Length::from_ratio(random.between(-5, 5), 1000);
    vertices.push_back({at(i % k_side), {}, at(i / k_side) + bend});
    if (i % k_side + 1 == k_side || i / k_side + 1 == k_side) continue;
    triangles.push_back({i, i + k_side, i + 1});
    triangles.push_back({i + 1, i + k_side, i + k_side + 1});
    if (i % 3 == 0) triangles.push_back({i, i + k_side, i + 1});
    if (i % 5 == 0) triangles.push_back({i, i, i + 1});
  }
  return Mesh::build({vertices, triangles, {}, {}, {}}).mesh;
}

struct Flakes {
  std::vector<AssetPtr> hulls;
  double refused = 0;
  double unexplained = 0;  ///< refused without a reason
};

Flakes make_flakes(arena::Random& random) {
  Flakes made;
  for (int i = 0; i < 400; ++i) {
    const HullResult built = Hull::build(flake(random));
    if (built.ok() && made.hulls.size() < 40) made.hulls.push_back(built.hull);
    made.refused += built.ok() ? 0 : 1;
    made.unexplained += built.ok() || built.fault != HullFault::none ? 0 : 1;
  }
  return made;
}

// Flakes fall on a floor, which is the last of the assets or a box.
StabilityResult drop_flakes(double seconds, bool on_mesh) {
  arena::Random random(7);
  const Flakes made = make_flakes(random);
  std::vector<AssetPtr> assets = made.hulls;
  assets.push_back(worn_floor(random));
  SceneRun scene(k_usual_setting, contact_world(), std::make_shared<const AssetSet>(assets));
  BodyDef floor = ground();
  if (on_mesh) {
    floor.shape = assets.back()->shape();
    floor.position = {};
  }
  scene.add(floor);
  for (std::size_t i = 0; i < made.hulls.size(); ++i) {
    const auto n = static_cast<int>(i);
    scene.add(
        body_at(made.hulls[i]->shape(), 1.2 * (n % 8) - 4.2, 0.6 + 0.3 * (n % 3), n / 8 - 2.0));
  }
  const auto [speed, depth] = worst_of(scene, seconds, greatest_speed, greatest_depth);
  return stability_of(
      scene, {{"refused without a reason", "", made.unexplained, 0},
              {"built fewer than 40 of 400", "", 40.0 - static_cast<double>(made.hulls.size()), 0},
              {"refused none of 400", "", made.refused > 0 ? 0.0 : 1.0, 0},
              {"greatest speed", "m/s", speed, 20},
              {"lowest centre below the floor, on impact", "m", depth, 0.02}});
}

StabilityResult flakes(double seconds) {
  return drop_flakes(seconds, false);
}
StabilityResult flakes_on_mesh(double seconds) {
  return drop_flakes(seconds, true);
}

// Balls, capsules and boxes fall on triangles as they come out of tools.
StabilityResult worn_mesh(double seconds) {
  arena::Random random(7);
  const AssetPtr mesh = worn_floor(random);
  SceneRun scene(k_usual_setting, contact_world(),
                 std::make_shared<const AssetSet>(std::vector<AssetPtr>{mesh}));
  BodyDef floor = body_at(mesh->shape(), 0, 0, 0);
  floor.motion = MotionType::static_body;
  scene.add(floor);
  for (int i = 0; i < 30; ++i) {
    const Shape shape = i % 3 == 0   ? Shape::sphere(0.2_m)
                        : i % 3 == 1 ? Shape::capsule(0.15_m, 0.2_m)
                                     : Shape::box(0.2_m, 0.05_m, 0.25_m);
    scene.add(body_at(shape, 1.0 * (i % 6) - 2.5, 1 + 0.2 * (i % 4), 1.0 * (i / 6) - 2));
  }
  const auto [speed, depth] = worst_of(scene, seconds, greatest_speed, greatest_depth);
  return stability_of(scene, {{"greatest speed", "m/s", speed, 20},
                              {"lowest centre below the floor", "m", depth, 0}});
}

// Beside the stirred pit, one that is loaded from it before every tick and has nothing derived.
StabilityResult rebuilt(double seconds) {
  SceneRun scene(k_usual_setting, contact_world(128)), twin(k_usual_setting, contact_world(128));
  fill_stirred_pit(scene);
  std::vector<std::byte> bytes(scene.world().snapshot_bytes_max(SnapshotKind::canonical));
  double differ = 0, refused = 0;
  bool loaded = false;
  const auto compare = [&](const World& world) {
    if (loaded && twin.world().hash().total != world.hash().total) ++differ;
    const std::size_t size = world.save(SnapshotKind::canonical, bytes);
    const Status status = twin.world().load(SnapshotKind::canonical, ByteView(bytes).first(size));
    loaded = status == Status::ok;
    if (!loaded) ++refused;
    if (loaded) twin.step();
    return 0.0;
  };
  (void)worst_of(scene, seconds, compare);
  return stability_of(scene, {{"ticks that came out otherwise", "", differ, 0},
                              {"snapshots refused", "", refused, 0}});
}

constexpr StabilityRow k_rows[] = {
    {"saturation", "forces, speeds and gravity of all that their types hold", 600, saturation},
    {"flakes", "hulls of nearly flat points, down to 1 mm, on a box", 600, flakes},
    {"flakes-on-mesh", "the same on a mesh with triangles of no area", 600, flakes_on_mesh},
    {"worn-mesh", "balls, capsules and boxes on that mesh", 600, worn_mesh},
    {"rebuilt", "the stirred pit, saved and loaded before every tick", 600, rebuilt},
};

}  // namespace

std::span<const StabilityRow> limit_rows() {
  return k_rows;
}

}  // namespace lockstone::bench
