// Scenes that a person pulls at, throws things into and takes things out of.
#include <algorithm>
#include <array>
#include <cmath>

#include <lockstone/testing/floating.h>
#include <lockstone/world.h>

#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"
#include "tools/studio/native/lockstone_studio.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

constexpr std::uint32_t k_spare_bodies = 512;

// The spring that pulls: critically damped, 1/s. Slow enough that a tick of it stays stable at the
// end of a thin bar, where a body yields four times as much as in its centre.
constexpr double k_pull_rate = 12;
constexpr double k_most_pull = 400;  // m/s²

using Doubles = std::array<double, 3>;

template <class T>
Doubles doubles(const Vec3<T>& v) {
  return {testing::to_double(v.x), testing::to_double(v.y), testing::to_double(v.z)};
}

template <class T>
Vec3<T> fixed(const std::int64_t (&raw)[3]) {
  return {T::from_raw(raw[0]), T::from_raw(raw[1]), T::from_raw(raw[2])};
}

template <class T>
T nearest(double value, int bits) {
  return T::from_raw(static_cast<decltype(T{}.raw)>(std::llround(std::ldexp(value, bits))));
}

Doubles cross(const Doubles& a, const Doubles& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// A scene is built by itself, so its world is no constant.
World& world_to_change(lks_world* world) {
  required(world, "world");
  return world->scene ? const_cast<World&>(world->scene->world()) : *world->own;
}

void perform(World& world, const Command& command) {
  const Status status = world.apply(command);
  if (status != Status::ok) throw_failure(status, world.explain(command));
}

// The force of the spring and a damper at the point, and the weight, so that nothing sags.
void pull(World& world, BodyHandle body, const lks_studio_action& action) {
  const BodyView view = world.body(body);
  if (view.motion != MotionType::dynamic) return;
  const Transform pose{view.position, view.orientation};
  const Vec3<Position> point = apply(pose, fixed<Position>(action.point));
  const Vec3<Position> arm = point - view.centre_of_mass;
  const Doubles way = doubles(fixed<Position>(action.place) - point);
  const Doubles turning = cross(doubles(view.angular_velocity), doubles(arm));
  const Doubles speed = doubles(view.velocity), gravity = doubles(world.def().gravity);
  Doubles pulled{};
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    pulled[i] = k_pull_rate * (k_pull_rate * way[i] - 2 * (speed[i] + turning[i]));
    square += pulled[i] * pulled[i];
  }
  const double scale = std::min(1.0, k_most_pull / std::sqrt(std::max(square, 1e-9)));
  const double mass = testing::to_double(view.mass.mass);
  const auto force = [&](std::size_t i) {
    return nearest<Force>(mass * (pulled[i] * scale - gravity[i]), LKS_FORCE_BITS);
  };
  const auto length = [](Position p) { return nearest<Length>(testing::to_double(p), 20); };
  perform(world, ApplyForceAt{body,
                              {force(0), force(1), force(2)},
                              {length(arm.x), length(arm.y), length(arm.z)},
                              Frame::world});
}

Shape spawned_shape(std::int64_t kind, Length size) {
  switch (kind) {
    case LKS_SPHERE:
      return Shape::sphere(size);
    case LKS_CAPSULE:
      return Shape::capsule(size, size / 2);
    case LKS_CYLINDER:
      return Shape::cylinder(size, size);
    case LKS_CONE:
      return Shape::cone(size * 2, size);
    case LKS_TAPERED_CAPSULE:
      return Shape::tapered_capsule(size * 2, size, size / 2);
    case LKS_ROUNDED_BOX:
      return Shape::rounded_box(size / 2, size / 2, size / 2, size / 2);
    default:
      return Shape::box(size, size, size);
  }
}

void spawn(World& world, const lks_studio_action& action) {
  BodyDef def;
  def.shape = spawned_shape(action.shape, Length::from_raw(static_cast<std::int32_t>(action.size)));
  def.position = fixed<Position>(action.place);
  def.velocity = fixed<Velocity>(action.speed);
  def.is_bullet = true;
  const Result<BodyHandle> body = world.create_body(def);
  if (!body.ok()) throw_failure(body.status(), world.explain(def));
  (void)world.set_name(body.value(), "thrown");
}

void push(World& world, BodyHandle body, const lks_studio_action& action) {
  if (world.body(body).motion != MotionType::dynamic) return;
  perform(world, SetVelocity{body, world.velocity(body) + fixed<Velocity>(action.speed)});
}

void act(World& world, const lks_studio_action& action) {
  if (action.kind == LKS_STUDIO_SPAWN) return spawn(world, action);
  const BodyHandle body = existing_body(world, static_cast<lks_body>(action.body));
  if (action.kind == LKS_STUDIO_PULL)
    pull(world, body, action);
  else if (action.kind == LKS_STUDIO_REMOVE)
    perform(world, DestroyBody{body});
  else if (action.kind == LKS_STUDIO_PUSH)
    push(world, body, action);
  else
    throw_invalid("action.kind", "there is no such action");
}

const std::vector<scenes::SceneSummary>& all_scenes() {
  static const std::vector<scenes::SceneSummary> list = scenes::list_scenes();
  return list;
}

}  // namespace

lks_status lks_studio_scene(const char* name, uint64_t seed, const int32_t* values, uint32_t count,
                            lks_world** out) {
  return call([&] {
    required(out, "out");
    auto scene = scenes::make_play(&required(name, "name"), seed, BroadPhaseKind::tree,
                                   k_spare_bodies, {values, count});
    if (!scene.ok()) throw_failure(scene.status());
    auto world = std::make_unique<lks_world>();
    world->scene = std::move(scene).value();
    *out = world.release();
  });
}

lks_status lks_studio_scene_parameter(uint32_t scene, uint32_t index, lks_studio_parameter* out) {
  return call([&] {
    const auto& list = all_scenes();
    const auto parameters = scene < list.size() ? scenes::parameters_of(list[scene].name)
                                                : std::vector<scenes::SceneParameter>{};
    if (index >= parameters.size()) throw_failure(Status::not_found);
    static std::string name;
    const scenes::SceneParameter& one = parameters[index];
    name = one.name;
    required(out, "out") = {name.c_str(), one.usual, one.least, one.most};
  });
}

const char* lks_studio_scene_text(uint32_t index) {
  return index < all_scenes().size() ? all_scenes()[index].description.data() : "";
}

lks_status lks_studio_act(lks_world* world, const lks_studio_action* action) {
  return call([&] { act(world_to_change(world), required(action, "action")); });
}
