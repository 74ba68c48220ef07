// Row 23: bullets and spinning rods against walls of a centimetre and sheets without thickness.
#include <algorithm>
#include <array>
#include <mutex>
#include <numbers>

#include <lockstone/compound.h>
#include <lockstone/height_field.h>
#include <lockstone/hull.h>
#include <lockstone/literals.h>
#include <lockstone/mesh.h>
#include <lockstone/world.h>

#include "tools/bench/accuracy/accuracy.h"
#include "tools/fuzz/dice.h"
#include "tools/support/for_blocks.h"

namespace lockstone::bench {
namespace {

using namespace literals;
using fuzz::Dice;
using fuzz::Real3;

constexpr int k_hulls = 64;
constexpr int k_compounds = 16;
constexpr std::uint64_t k_block = 64;  // tries in one world
constexpr double k_rim = 19;           // a body that lands beyond it went round the wall

Vec3<Position> to_position(const Real3& v) {
  const auto lane = [](double x) { return Position::from_raw(std::llround(std::ldexp(x, 32))); };
  return {lane(v.x), lane(v.y), lane(v.z)};
}
template <class T>
Vec3<T> as(const Real3& v) {
  const Vec3<Position> p = to_position(v);
  return {T::from_raw(p.x.raw), T::from_raw(p.y.raw), T::from_raw(p.z.raw)};
}

/// Walls that lie in the plane y = 0, met from above.
struct Walls {
  Shape box = Shape::box(20_m, 0.005_m, 20_m);
  AssetPtr mesh;
  AssetPtr height_field;
};

constexpr int k_cells = 16;

AssetPtr sheet() {
  std::vector<Vec3<Length>> vertices;
  std::vector<TriangleIndices> triangles;
  const auto at = [](int i, int j) { return static_cast<std::uint32_t>(j * (k_cells + 1) + i); };
  for (int j = 0; j <= k_cells; ++j)
    for (int i = 0; i <= k_cells; ++i)
      vertices.push_back(fuzz::to_length({i * 2.5 - 20, 0, j * 2.5 - 20}));
  for (int j = 0; j < k_cells; ++j) {
    for (int i = 0; i < k_cells; ++i) {
      triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  MeshDef def;
  def.vertices = vertices;
  def.triangles = triangles;
  return Mesh::build(def).mesh;
}

AssetPtr terrain() {
  constexpr std::uint32_t k_samples = k_cells + 1;
  const std::vector<Length> heights(k_samples * k_samples);
  HeightFieldDef def;
  def.columns = def.rows = k_samples;
  def.origin = {-20_m, {}, -20_m};
  def.cell_x = def.cell_z = 2.5_m;
  def.heights = heights;
  return HeightField::build(def).height_field;
}

AssetPtr small_hull(Dice& dice) {
  for (;;) {
    std::vector<Vec3<Length>> points;
    for (std::int64_t count = dice.between(4, 24); count > 0; --count)
      points.push_back(fuzz::to_length(dice.direction() * 0.03));
    if (const HullResult result = Hull::build(points); result.ok()) return result.hull;
  }
}

AssetPtr small_compound(Dice& dice) {
  const Length r = dice.size(0.01, 0.03);
  std::vector<CompoundChild> children(2);
  children[0].shape = Shape::sphere(r);
  children[0].position = fuzz::to_length(dice.direction() * 0.03);
  children[1].shape = Shape::box(r, r, r);
  children[1].orientation = dice.orientation();
  return Compound::build(children).compound;
}

/// Everything that the tries use.
struct Range {
  Walls walls;
  std::vector<AssetPtr> hulls;
  std::vector<AssetPtr> compounds;
  std::shared_ptr<const AssetSet> assets;

  explicit Range(std::uint64_t seed) {
    Dice dice(seed, 0);
    walls.mesh = sheet();
    walls.height_field = terrain();
    std::vector<AssetPtr> all{walls.mesh, walls.height_field};
    for (int i = 0; i < k_hulls; ++i)
      hulls.push_back(all.emplace_back(small_hull(dice)));
    for (int i = 0; i < k_compounds; ++i)
      compounds.push_back(all.emplace_back(small_compound(dice)));
    assets = std::make_shared<const AssetSet>(all);
  }
};

Shape pick(Dice& dice, const std::vector<AssetPtr>& assets) {
  return assets[static_cast<std::size_t>(dice.between(0, std::ssize(assets) - 1))]->shape();
}

Shape bullet_shape(Dice& dice, const Range& range) {
  const Length x = dice.size(0.01, 0.06), y = dice.size(0.01, 0.06), z = dice.size(0.01, 0.06);
  switch (dice.between(0, 4)) {
    case 0:
      return Shape::sphere(x);
    case 1:
      return Shape::capsule(x, y);
    case 2:
      return Shape::box(x, y, z);
    case 3:
      return pick(dice, range.hulls);
    default:
      return pick(dice, range.compounds);
  }
}

// Within two ticks of the wall, from any side, at up to 500 m/s.
BodyDef bullet(Dice& dice, const Range& range) {
  BodyDef def;
  def.shape = bullet_shape(dice, range);
  const double speed = dice.chance(4) ? 499.9 : dice.uniform(20, 499.9);
  const double lean = dice.uniform(0, 1.2), turn = dice.uniform(0, 2 * std::numbers::pi);
  const Real3 way{std::sin(lean) * std::cos(turn), -std::cos(lean),
                  std::sin(lean) * std::sin(turn)};
  const double height = 0.12 + dice.uniform(0, 2) * speed * std::cos(lean) / 60;
  const Real3 aim = dice.in_cube(5);
  def.position = to_position(Real3{aim.x, height, aim.z});
  def.velocity = as<Velocity>(way * speed);
  def.orientation = dice.orientation();
  def.angular_velocity = as<AngularVelocity>(dice.direction() * dice.uniform(0, 300));
  def.material.restitution = fuzz::to_unit(dice.chance(3) ? 0 : dice.uniform(0, 1));
  def.material.friction = fuzz::to_unit(dice.uniform(0, 1));
  return def;
}

// Two metres long and a few centimetres thick, spinning nearly as fast as it may.
BodyDef rod(Dice& dice, const Range&) {
  BodyDef def;
  const Length thin = dice.size(0.005, 0.03);
  def.shape = dice.chance(2) ? Shape::capsule(1_m, thin) : Shape::box(thin, 1_m, thin);
  def.position = to_position({0, dice.uniform(1.05, 1.6), 0});
  def.orientation = dice.orientation();
  def.velocity = as<Velocity>({dice.uniform(-20, 20), -dice.uniform(0, 100), 0});
  Real3 axis = dice.direction();
  axis.y = axis.y * 0.2;
  def.angular_velocity = as<AngularVelocity>(direction_of(axis) * dice.uniform(20, 240));
  def.material.restitution = fuzz::to_unit(dice.chance(2) ? 0 : dice.uniform(0, 1));
  return def;
}

using MakeBody = BodyDef (*)(Dice&, const Range&);

// Whether the body's centre of mass is found below the wall.
bool passes(World& world, const BodyDef& def, int ticks) {
  const BodyHandle body = world.create_body(def).value();
  bool passed = false;
  for (int tick = 0; tick < ticks && !passed; ++tick) {
    (void)world.step();
    const BodyView view = world.body(body);
    const Real3 at = fuzz::real(view.centre_of_mass);
    if (std::abs(at.x) > k_rim || std::abs(at.z) > k_rim || at.y > 12) break;
    passed = at.y < 0;
  }
  (void)world.apply(DestroyBody{body});
  return passed;
}

struct Case {
  std::string_view name;
  Shape wall;
  MakeBody make;
  int ticks;
};

// The first of them.
std::string note_of(std::vector<std::uint64_t> tries) {
  std::ranges::sort(tries);
  std::string note = tries.empty() ? "" : "tries";
  for (std::size_t i = 0; i < std::min<std::size_t>(tries.size(), 4); ++i)
    note.append(" ").append(std::to_string(tries[i]));
  return note;
}

AccuracyResult count_tunnels(const Case& c, const Range& range, const AccuracyOptions& options) {
  const std::uint64_t tries = options.tries;
  std::mutex mutex;
  std::vector<std::uint64_t> passed;
  tool::for_blocks(tries, k_block, options.threads, [&](std::uint64_t first, std::uint64_t count) {
    WorldDef def;
    def.body_capacity = 4;
    def.pair_capacity = def.contact_capacity = 64;
    def.gravity = {};
    World world = World::create(def, range.assets).value();
    BodyDef wall;
    wall.motion = MotionType::static_body;
    wall.shape = c.wall;
    (void)world.create_body(wall).value();
    for (std::uint64_t i = options.first + first; i < options.first + first + count; ++i) {
      Dice dice(options.seed, i);
      if (!passes(world, c.make(dice, range), c.ticks)) continue;
      const std::lock_guard lock(mutex);
      passed.push_back(i);
    }
  });
  return {std::string(c.name), "passed", tries, static_cast<double>(passed.size()), 0,
          note_of(passed)};
}

}  // namespace

std::vector<AccuracyResult> measure_tunnels(const AccuracyOptions& options) {
  const Range range(options.seed);
  const Shape mesh = range.walls.mesh->shape(), field = range.walls.height_field->shape();
  std::vector<AccuracyResult> results;
  for (const Case& c : std::array<Case, 6>{{{"bullets, box of 1 cm", range.walls.box, bullet, 6},
                                            {"bullets, mesh sheet", mesh, bullet, 6},
                                            {"bullets, height field", field, bullet, 6},
                                            {"rods, box of 1 cm", range.walls.box, rod, 20},
                                            {"rods, mesh sheet", mesh, rod, 20},
                                            {"rods, height field", field, rod, 20}}})
    results.push_back(count_tunnels(c, range, options));
  return results;
}

}  // namespace lockstone::bench
