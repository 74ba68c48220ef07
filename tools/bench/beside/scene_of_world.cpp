#include "tools/bench/beside/scene_of_world.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <lockstone/compound.h>
#include <lockstone/debug_draw.h>
#include <lockstone/hull.h>
#include <lockstone/mesh.h>

#include "core/geometry/assets/mesh_geometry.h"
#include "tools/bench/general/vectors.h"
#include "tools/fuzz/real.h"

namespace lockstone::bench {
namespace {

using namespace general;

template <class T>
Triple triple(const Vec3<T>& v) {
  const fuzz::Real3 r = fuzz::real(v);
  return {r.x, r.y, r.z};
}

Turn turn_of(const Quat& q) {
  return {fuzz::real(q.x), fuzz::real(q.y), fuzz::real(q.z), fuzz::real(q.w)};
}

// Of a rotation's columns. Two of the squares are never both small.
Turn turn_of(const Mat3& m) {
  const Triple x = triple(m.x), y = triple(m.y), z = triple(m.z);
  const Turn squares{1 + x[0] - y[1] - z[2], 1 - x[0] + y[1] - z[2], 1 - x[0] - y[1] + z[2],
                     1 + x[0] + y[1] + z[2]};
  const double xy = x[1] + y[0], yz = y[2] + z[1], zx = z[0] + x[2];
  const double wx = y[2] - z[1], wy = z[0] - x[2], wz = x[1] - y[0];
  const std::array<Turn, 4> rows{Turn{squares[0], xy, zx, wx}, Turn{xy, squares[1], yz, wy},
                                 Turn{zx, yz, squares[2], wz}, Turn{wx, wy, wz, squares[3]}};
  const auto most = std::ranges::max_element(squares) - squares.begin();
  Turn turn = rows[static_cast<std::size_t>(most)];
  const double size = std::hypot(std::hypot(turn[0], turn[1]), std::hypot(turn[2], turn[3]));
  for (double& component : turn)
    component /= size;
  return turn;
}

double volume_of_hull(const Hull& hull) {
  double volume = 0;
  for (int face = 0; face < hull.face_count(); ++face) {
    const std::vector<int> corners = hull.face_vertices(face);
    const auto at = [&](std::size_t i) {
      return triple(hull.vertices()[static_cast<std::size_t>(corners[i])]);
    };
    for (std::size_t i = 2; i < corners.size(); ++i)
      volume += dot(at(0), cross(at(i - 1), at(i))) / 6;
  }
  return volume;
}

void read_mesh(GeneralShape& shape, const Asset& mesh) {
  const geometry::MeshData& data = geometry::mesh_data(mesh.geometry());
  shape.form = Form::mesh;
  for (const Vec3<Length>& vertex : data.soup.vertices)
    shape.points.push_back(triple(vertex));
  for (std::uint32_t i = 0; i < data.soup.triangles.size(); ++i) {
    const TriangleIndices t = data.indices(i);
    shape.triangles.push_back(
        {static_cast<int>(t.a), static_cast<int>(t.b), static_cast<int>(t.c)});
  }
}

// Of one part. False for a kind that plain numbers do not know.
bool read_shape(GeneralShape& shape, const Shape& from, const Asset* asset) {
  shape.size = triple(from.size);
  switch (from.kind) {
    case ShapeKind::sphere:
      shape.form = Form::sphere;
      return true;
    case ShapeKind::capsule:
      shape.form = Form::capsule;
      return true;
    case ShapeKind::box:
      shape.form = Form::box;
      return true;
    case ShapeKind::hull:
      shape.form = Form::hull;
      for (const Vec3<Length>& vertex : static_cast<const Hull*>(asset)->vertices())
        shape.points.push_back(triple(vertex));
      return static_cast<const Hull*>(asset)->radius() == Length{};
    case ShapeKind::mesh:
      read_mesh(shape, *asset);
      return true;
    default:
      return false;
  }
}

bool read_parts(GeneralBody& body, const Compound& compound) {
  body.form = Form::compound;
  for (const CompoundChild& child : compound.children()) {
    GeneralPart& part = body.parts.emplace_back();
    part.position = triple(child.position);
    part.orientation = turn_of(child.orientation);
    if (child.shape.kind == ShapeKind::mesh) return false;
    if (!read_shape(part, child.shape, child.asset.get())) return false;
  }
  return true;
}

Motion motion_of(MotionType motion) {
  if (motion == MotionType::static_body) return Motion::fixed;
  return motion == MotionType::kinematic ? Motion::kinematic : Motion::dynamic;
}

// Names the first property that a scene in plain numbers has no place for.
std::string foreign_to(const BodyView& view) {
  if (view.is_asleep) return "bodies that sleep at the beginning";
  if (view.linear_damping.raw != 0 || view.angular_damping.raw != 0) return "damping";
  if (view.gravity_scale != Number::from_integer(1)) return "a scale of gravity";
  if (view.surface_motion != SurfaceMotion{}) return "a moving surface";
  CollisionFilter filter = view.filter;
  if (filter.mask == 0) filter.mask = CollisionFilter{}.mask;
  return filter == CollisionFilter{} ? "" : "a filter of collisions";
}

class Follower final : public DebugDraw {
 public:
  Follower(const SpeedScene& scene, int ticks) : world_(scene.make(BroadPhaseKind::tree)) {
    GeneralScene& out = result_.scene;
    out.family = scene.name;
    out.ticks = ticks;
    out.gravity = -fuzz::real(world_.def().gravity.y);
    out.may_sleep = world_.def().sleep_ms != 0;
    if (scene.asks) result_.lacking = "queries";
    for (int tick = 0; tick < ticks && result_.lacking.empty(); ++tick) {
      if (scene.drive != nullptr) scene.drive(world_);
      follow(tick);
      if (scene.drive == nullptr) break;
      (void)world_.step();
    }
  }
  [[nodiscard]] SceneOfWorld take() { return std::move(result_); }

 private:
  struct Followed {
    int index = 0;
    std::optional<std::pair<Vec3<Velocity>, Vec3<AngularVelocity>>> motion;  // of a kinematic one
  };

  void follow(int tick) {
    std::erase_if(bodies_, [&](const auto& entry) {
      if (world_.exists(entry.first)) return false;
      body(entry.second.index).until = tick;
      return true;
    });
    std::vector<BodyHandle> added;
    for (std::uint32_t i = 0; i < world_.body_limit(); ++i) {
      const BodyHandle handle = world_.body_at(i);
      if (!handle.is_null() && bodies_.count(handle) == 0) added.push_back(handle);
    }
    for (const BodyHandle handle : added)
      add(handle, tick);
    if (!added.empty()) world_.draw(*this, {.shapes = false, .joints = true});
    for (const BodyHandle handle : added)
      if (world_.body(handle).motion == MotionType::dynamic)
        LKS_CHECK(world_.apply(SetEnabled{handle, false}) == Status::ok);
    for (auto& [handle, followed] : bodies_)
      follow_motion(handle, followed, tick);
  }

  void add(BodyHandle handle, int tick) {
    const BodyView view = world_.body(handle);
    bodies_[handle].index = static_cast<int>(result_.scene.bodies.size());
    GeneralBody& out = result_.scene.bodies.emplace_back();
    out.motion = motion_of(view.motion);
    out.from = tick;
    out.position = triple(view.position);
    out.orientation = turn_of(view.orientation);
    out.velocity = triple(view.velocity);
    out.angular_velocity = triple(view.angular_velocity);
    out.friction = fuzz::real(view.surface.friction);
    out.restitution = fuzz::real(view.surface.restitution);
    out.collides = view.filter.mask != 0;
    out.trigger = view.is_trigger;
    out.bullet = view.is_bullet;
    const std::string foreign = foreign_to(view);
    if (!foreign.empty()) result_.lacking = foreign;
    const Asset* asset = world_.assets()->find(view.shape.asset_id());
    const bool known = view.shape.kind == ShapeKind::compound
                           ? read_parts(out, *static_cast<const Compound*>(asset))
                           : read_shape(out, view.shape, asset);
    if (!known) result_.lacking = "a shape: " + std::string(to_string(view.shape.kind));
    if (out.moves() && known) set_density(out, view, asset);
  }

  static void set_density(GeneralBody& out, const BodyView& view, const Asset* asset) {
    const double volume =
        out.form == Form::hull ? volume_of_hull(*static_cast<const Hull*>(asset)) : volume_of(out);
    out.density = fuzz::real(view.mass.mass) / volume;
  }

  void follow_motion(BodyHandle handle, Followed& followed, int tick) {
    if (body(followed.index).motion != Motion::kinematic) return;
    const BodyView view = world_.body(handle);
    const std::pair motion{view.velocity, view.angular_velocity};
    if (followed.motion.has_value() && *followed.motion != motion)
      result_.scene.moves.push_back(
          {tick, followed.index, triple(motion.first), triple(motion.second)});
    followed.motion = motion;
  }

  void draw_joint(const DebugJoint& joint) override {
    if (!joints_.insert(joint.joint).second) return;
    GeneralJoint& out = result_.scene.joints.emplace_back();
    out.a = bodies_[joint.view.body_a].index;
    out.b = bodies_[joint.view.body_b].index;
    const Turn from_a = inverse(body(out.a).orientation), from_b = inverse(body(out.b).orientation);
    out.anchor_a = turned(from_a, triple(joint.place_a) - body(out.a).position);
    out.anchor_b = turned(from_b, triple(joint.place_b) - body(out.b).position);
    out.frame_a = from_a * turn_of(joint.frame_a);
    out.frame_b = from_b * turn_of(joint.frame_b);
    out.limited = joint.modes[3] == AxisMode::limited;
    out.lower = fuzz::real(joint.angular_lower[0]);
    out.upper = fuzz::real(joint.angular_upper[0]);
    out.cone = fuzz::real(joint.angular_upper[1]);
    out.link = joint.view.kind == JointKind::hinge ? Link::hinge : Link::ball;
    const bool limits_swing = joint.modes[4] == AxisMode::limited;
    const bool known = joint.view.kind == JointKind::hinge ||
                       (joint.view.kind == JointKind::ball && limits_swing == out.limited);
    if (!known) result_.lacking = "a joint: " + std::string(to_string(joint.view.kind));
  }

  [[nodiscard]] GeneralBody& body(int index) {
    return result_.scene.bodies[static_cast<std::size_t>(index)];
  }

  World world_;
  SceneOfWorld result_;
  std::map<BodyHandle, Followed> bodies_;  // those that are there
  std::set<JointHandle> joints_;           // all that ever were
};

}  // namespace

SceneOfWorld scene_of_world(const SpeedScene& scene, int ticks) {
  return Follower(scene, ticks).take();
}

}  // namespace lockstone::bench
