// The state of a world as numbers to draw, and figures of it.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include <lockstone/testing/floating.h>
#include <lockstone/world.h>

#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"
#include "tools/studio/native/lockstone_studio.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

constexpr std::size_t k_lists = 5;

template <class T>
float number(T value) {
  return static_cast<float>(testing::to_double(value));
}

template <class T>
double square(const Vec3<T>& v) {
  const double x = testing::to_double(v.x), y = testing::to_double(v.y),
               z = testing::to_double(v.z);
  return x * x + y * y + z * z;
}

template <class T>
float size_of(const Vec3<T>& v) {
  return static_cast<float>(std::sqrt(square(v)));
}

// Tells a changed shape from the old one: 24 bits, which a float holds exactly.
float mark_of(const Shape& shape) {
  std::uint64_t mark = static_cast<std::uint64_t>(shape.kind) + shape.asset.value;
  for (const Length size : {shape.size.x, shape.size.y, shape.size.z})
    mark = mark * 0x9e3779b97f4a7c15U + static_cast<std::uint32_t>(size.raw);
  return static_cast<float>(mark * 0x9e3779b97f4a7c15U >> 40);
}

/// Collects the numbers of each list.
class Lists final : public DebugDraw {
 public:
  void clear() {
    for (std::vector<float>& list : lists_)
      list.clear();
  }
  [[nodiscard]] lks_studio_list at(std::size_t i) const {
    return {lists_[i].data(), static_cast<std::uint32_t>(lists_[i].size())};
  }

  void draw_shape(const DebugShape& shape) override {
    add(0, row(shape.body), static_cast<float>(shape.state),
        shape.island.is_null() ? -1.0F : row(shape.island), mark_of(shape.shape));
  }
  void draw_bounds(const DebugBounds& bounds) override {
    add(1, row(bounds.body));
    add_vector(1, bounds.lower);
    add_vector(1, bounds.upper);
  }
  void draw_mass(const DebugMass& mass) override {
    add(2, row(mass.body));
    add_vector(2, mass.centre);
    for (const auto& column : {mass.axes.x, mass.axes.y, mass.axes.z})
      add_vector(2, column);
    add(2, number(mass.mass));
  }
  void draw_contact(const DebugContact& contact) override {
    if (!contact.touching) return;
    for (std::uint32_t i = 0; i < contact.count; ++i) {
      add(3, row(contact.a), row(contact.b));
      add_vector(3, contact.points[i].point);
      add_vector(3, contact.normal);
      add(3, number(contact.points[i].force), number(contact.points[i].separation));
    }
  }
  void draw_joint(const DebugJoint& joint) override {
    add(4, static_cast<float>(joint.joint.index), row(joint.view.body_a), row(joint.view.body_b),
        static_cast<float>(joint.view.kind));
    add_vector(4, joint.place_a);
    add_vector(4, joint.place_b);
    add(4, size_of(joint.view.force), size_of(joint.view.torque));
  }

 private:
  static float row(BodyHandle body) { return static_cast<float>(body.index); }

  template <class... Numbers>
  void add(std::size_t list, Numbers... numbers) {
    (lists_[list].push_back(numbers), ...);
  }
  template <class T>
  void add_vector(std::size_t list, const Vec3<T>& v) {
    add(list, number(v.x), number(v.y), number(v.z));
  }

  std::array<std::vector<float>, k_lists> lists_;
};

/// Counts the islands that are awake.
class Islands final : public DebugDraw {
 public:
  void draw_shape(const DebugShape& shape) override {
    if (shape.state == DebugState::awake && !shape.island.is_null())
      roots_.insert(shape.island.index);
  }
  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(roots_.size()); }

 private:
  std::set<std::uint32_t> roots_;
};

// ½·ω·I·ω along the principal axes.
double turning_energy(const BodyView& body) {
  const Mat3 axes = to_matrix(body.principal_axes);
  const auto along = [&](const auto& axis) {
    const auto part = [](auto a, auto b) { return testing::to_double(a) * testing::to_double(b); };
    const double speed = part(axis.x, body.angular_velocity.x) +
                         part(axis.y, body.angular_velocity.y) +
                         part(axis.z, body.angular_velocity.z);
    return speed * speed;
  };
  return (testing::to_double(body.mass.inertia.x) * along(axes.x) +
          testing::to_double(body.mass.inertia.y) * along(axes.y) +
          testing::to_double(body.mass.inertia.z) * along(axes.z)) /
         2;
}

void add_energy(const BodyView& body, const WorldDef& def, lks_studio_figures& figures) {
  const double mass = testing::to_double(body.mass.mass);
  figures.kinetic += mass * square(body.velocity) / 2 + turning_energy(body);
  const auto height = [&](Acceleration g, Position p) {
    return -testing::to_double(g) * testing::to_double(p);
  };
  figures.potential +=
      mass * testing::to_double(body.gravity_scale) *
      (height(def.gravity.x, body.centre_of_mass.x) + height(def.gravity.y, body.centre_of_mass.y) +
       height(def.gravity.z, body.centre_of_mass.z));
}

void add_bodies(const World& world, lks_studio_figures& figures) {
  for (std::uint32_t row = 0; row < world.body_limit(); ++row) {
    const BodyHandle handle = world.body_at(row);
    if (handle.is_null()) continue;
    ++figures.bodies;
    const BodyView body = world.body(handle);
    if (body.motion != MotionType::dynamic || !body.is_enabled) continue;
    ++(body.is_asleep ? figures.asleep : figures.awake);
    add_energy(body, world.def(), figures);
  }
}

lks_studio_figures figures_of(const lks_world& world) {
  lks_studio_figures figures{};
  add_bodies(world.world(), figures);
  Islands islands;
  world.world().draw(islands);
  figures.islands = islands.count();
  figures.joints = world.world().joint_count();
  if (world.scene) {
    figures.contacts = world.scene->last_report().contacts;
    figures.points = world.scene->last_report().contact_points;
  }
  return figures;
}

DebugDrawOptions options_of(std::uint32_t wanted) {
  return {.shapes = (wanted & LKS_STUDIO_BODIES) != 0,
          .bounds = (wanted & LKS_STUDIO_BOUNDS) != 0,
          .masses = (wanted & LKS_STUDIO_MASSES) != 0,
          .contacts = (wanted & LKS_STUDIO_CONTACTS) != 0,
          .joints = (wanted & LKS_STUDIO_JOINTS) != 0};
}

}  // namespace

lks_status lks_studio_draw(const lks_world* world, uint32_t wanted, lks_studio_list* lists) {
  static Lists drawn;
  return call([&] {
    required(lists, "lists");
    drawn.clear();
    read(world).draw(drawn, options_of(wanted));
    for (std::size_t i = 0; i < k_lists; ++i)
      lists[i] = drawn.at(i);
  });
}

lks_status lks_studio_measure(const lks_world* world, lks_studio_figures* out) {
  return call([&] { required(out, "out") = figures_of(handle(world)); });
}
