#include "tools/scenes/build.h"

#include <string>

namespace lockstone::scenes {

using namespace lockstone::literals;

namespace {

void count_in(World& world, BodyHandle body, EventKind kind) {
  const BodyView view = world.body(body);
  if (!view.is_trigger) return;
  const std::uint64_t one = kind == EventKind::trigger_enter ? 1 : std::uint64_t{1} << 32;
  order(world, SetUserData{body, view.user_data + one});
}

}  // namespace

WorldDef small_world() {
  WorldDef def;
  def.body_capacity = 256;
  def.pair_capacity = 4096;
  def.contact_capacity = 2048;
  return def;
}

BodyHandle add(World& world, const BodyDef& def) {
  const Result<BodyHandle> body = world.create_body(def);
  LKS_CHECK(body.ok());
  (void)world.set_name(body.value(), to_string(def.shape.kind));
  return body.value();
}

void order(World& world, const Command& command) {
  const Status status = world.apply(command);
  LKS_CHECK(status == Status::ok);
}

BodyDef fixed(const Shape& shape, const Vec3<Position>& position) {
  BodyDef def = loose(shape, position);
  def.motion = MotionType::static_body;
  return def;
}

BodyDef fixed_box(const Vec3<Position>& position, const Vec3<Length>& half_extents) {
  return fixed(Shape::box(half_extents.x, half_extents.y, half_extents.z), position);
}

BodyDef loose(const Shape& shape, const Vec3<Position>& position) {
  BodyDef def;
  def.shape = shape;
  def.position = position;
  return def;
}

void count_in_triggers(World& world) {
  for (const ContactEvent& event : world.events()) {
    if (event.kind != EventKind::trigger_enter && event.kind != EventKind::trigger_exit) continue;
    count_in(world, event.a, event.kind);
    count_in(world, event.b, event.kind);
  }
}

void add_ground(World& world, Length half_width) {
  const BodyHandle ground =
      add(world, fixed_box({{}, -0.5_m, {}}, {half_width, 0.5_m, half_width}));
  (void)world.set_name(ground, "ground");
}

void add_stack(World& world, const Vec3<Position>& base, int count) {
  const Shape box = Shape::box(0.5_m, 0.5_m, 0.5_m);
  for (int i = 0; i < count; ++i) {
    const Position height = Position::from_ratio(2 * i + 1, 2);
    const BodyHandle body = add(world, loose(box, base + Vec3<Position>{{}, height, {}}));
    (void)world.set_name(body, "box " + std::to_string(i));
  }
}

Shape random_shape(Random& random) {
  const auto size = [&] { return millimetres_long(random.between(150, 450)); };
  const std::uint32_t kind = random.below(3);
  const Length x = size(), y = size(), z = size();
  if (kind == 0) return Shape::sphere(x);
  if (kind == 1) return Shape::capsule(y, Length::from_raw(x.raw * 2 / 3));
  return Shape::box(x, y, z);
}

Quat random_orientation(Random& random) {
  const auto component = [&] { return Unit::from_raw(random.between(-(1 << 29), 1 << 29)); };
  const Unit x = component(), y = component(), z = component(), w = component();
  return normalized({x, y, z, w});
}

}  // namespace lockstone::scenes
