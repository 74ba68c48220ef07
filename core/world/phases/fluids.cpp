#include "core/world/phases/fluids.h"

#include <algorithm>
#include <optional>

#include <lockstone/assert.h>

#include "core/dynamics/body/motion.h"
#include "core/dynamics/body/tick_gain.h"
#include "core/dynamics/state/limits.h"
#include "core/math/roots.h"
#include "core/math/rotation_log.h"
#include "core/math/rounded_dot.h"
#include "core/world/derived/quantities.h"
#include "core/world/phases/immersion.h"

namespace lockstone {
namespace {

constexpr std::int64_t k_unit_32 = std::int64_t{1} << 32;

std::int64_t product_q32(std::int64_t a, std::int64_t b) {
  return saturated_product(a, b, 32);
}

// x / (1 + x) of x ≥ 0, 32 bits both.
std::int64_t braked_part(std::int64_t x) {
  LKS_ASSERT(x >= 0);
  const std::int64_t bounded = std::min(x, std::int64_t{1} << 60);
  return round_divide(multiply_wide(bounded, k_unit_32), k_unit_32 + bounded);
}

// arm × v over 2^exponent, 32 bits; the arm is a length in m.
Vec3<Velocity> turning_of(const Vec3<Position>& arm, const Vec3<Velocity>& v, int exponent) {
  constexpr std::int64_t k_bound = std::int64_t{1} << 50;
  Vec3<Velocity> turning;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const std::int64_t value =
        raw::saturating_add(product_q32(arm[j].raw, v[k].raw), -product_q32(arm[k].raw, v[j].raw));
    turning[i].raw = raw::scale_binary(std::clamp(value, -k_bound, k_bound), -exponent);
  }
  return turning;
}

Vec3<Velocity> times(const Vec3<Velocity>& v, std::int64_t factor) {
  return {Velocity::from_raw(product_q32(v.x.raw, factor)),
          Velocity::from_raw(product_q32(v.y.raw, factor)),
          Velocity::from_raw(product_q32(v.z.raw, factor))};
}

// Where a body is in the middle of a tick in which nothing but gravity moves it.
Vec3<Position> mid_tick_position(const WorldData& world, const BodyRecord& body) {
  const Vec3<Velocity> fall =
      gravity_gain(body, world.header.gravity, world.time_step, Unit::from_ratio(1, 4));
  Vec3<Position> position = body.position;
  for (int i = 0; i < 3; ++i)
    position[i].raw += world.time_step.tick.times(body.velocity[i].raw / 2 + fall[i].raw);
  return position;
}

// The body there, turned.
BodyRecord in_mid_tick(const WorldData& world, std::uint32_t body, const Vec3<Position>& position) {
  BodyRecord record = world.bodies[body];
  record.position = position;
  (void)turn_in_flight(record, world.cache.rotation(body), world.time_step, Unit::from_ratio(1, 2));
  return record;
}

bool is_inside(const FluidRecord& fluid, const Vec3<Position>& point, Position reach) {
  const Vec3<Position> at = rotate_inverse(to_matrix(fluid.orientation), point - fluid.surface);
  return is_within(at.x, fluid.size.x) && is_within(at.z, fluid.size.z) && at.y >= -fluid.size.y &&
         at.y <= reach;
}

// The forces of one fluid on one body in a tick, as velocities.
class FluidPush {
 public:
  FluidPush(const WorldData& world, std::uint32_t body, const BodyRecord& middle,
            const FluidRecord& fluid)
      : world_(world), start_(world.bodies[body]), fluid_(fluid) {
    const Vec3<Velocity> through = start_.velocity - fluid.flow;
    const bool drags = fluid.drag > Number{} && through != Vec3<Velocity>{};
    const PlacedShape placed = place(start_.shape(), world.cache.asset(body), middle.position,
                                     to_matrix(middle.orientation));
    in_ = immersion_of(start_, placed, fluid, drags ? direction_of(through) : Vec3<Unit>{});
    if (in_.share == 0) return;
    rise();
    brake(through,
          surface_velocity(inverse_inertia(start_, world.cache.rotation(body)), start_.spin));
  }

  [[nodiscard]] const TickGain& gain() const { return gain_; }

 private:
  // Buoyancy is a spring as stiff as the section that it sinks with. Its force in the middle of
  // the tick is that of the pose there, which the force itself moves: the implicit midpoint rule,
  // which neither feeds nor starves the oscillation, and holds for the lightest bodies.
  void rise() {
    const Vec3<Velocity> weight{in_tick(world_.header.gravity.x), in_tick(world_.header.gravity.y),
                                in_tick(world_.header.gravity.z)};
    const Vec3<Unit> up = to_matrix(fluid_.orientation).y;
    const std::int64_t along = rounded_dot(weight, up);
    const std::int64_t sinking = world_.time_step.tick.times(std::abs(along)) / 4;
    const std::int64_t kept = k_unit_32 - braked_part(product_q32(in_.per_metre, sinking));
    lift_ = times(weight, -kept);
    gain_.velocity = times(lift_, in_.share);
    gain_.spin = turning_of(in_.moment, lift_, start_.scale_exponent);
  }

  [[nodiscard]] Velocity in_tick(Acceleration g) const {
    return Velocity::from_raw(raw::round_divide(g.raw, world_.def.tick_rate));
  }

  // The rate of braking b takes the velocity u through the fluid to (u + a·dt) / (1 + b·dt), a the
  // other accelerations: it decays however strong the drag is, and the terminal velocity is exact.
  void brake(const Vec3<Velocity>& through, const Vec3<Velocity>& turning) {
    Vec3<Position> centre;  // of the displaced fluid, from the centre of mass
    for (int i = 0; i < 3; ++i)
      centre[i].raw = divide_to_q32(in_.moment[i].raw, in_.share);
    Vec3<Velocity> u = through + velocity_around(turning, centre, start_.scale_exponent);
    const std::int64_t speed = static_cast<std::int64_t>(
        std::min(norm(u.x.raw, u.y.raw, u.z.raw), std::uint64_t{1} << 50));
    const std::int64_t form =
        product_q32(product_q32(in_.shadow, speed) / 2,
                    std::int64_t{fluid_.drag.raw} << (32 - Number::frac_bits));
    const std::int64_t linear =
        product_q32(in_.share, std::int64_t{fluid_.linear_drag.raw} << (32 - Rate::frac_bits));
    if (form == 0 && linear == 0) return;
    u += gain_.velocity + tick_gain(start_, world_.header.gravity, world_.time_step);
    const std::int64_t rate = raw::saturating_add(form, linear);
    const Vec3<Velocity> drag = times(u, -braked_part(world_.time_step.tick.times(rate)));
    gain_.velocity += drag;
    gain_.spin += turning_of(centre, drag, start_.scale_exponent);
    const std::int64_t slowed = braked_part(world_.time_step.tick.times(linear));
    gain_.spin += times(start_.spin + gain_.spin, -slowed);
  }

  [[nodiscard]] static std::int64_t divide_to_q32(std::int64_t a, std::int64_t b) {
    constexpr std::int64_t k_bound = std::int64_t{1} << 43;  // 2048 m
    const Int128 wide = Int128::from(a) << 32;
    if (magnitude(wide).high >= static_cast<std::uint64_t>(b) >> 1)
      return a < 0 ? -k_bound : k_bound;
    return std::clamp(round_divide(wide, b), -k_bound, k_bound);
  }

  const WorldData& world_;
  const BodyRecord& start_;
  const FluidRecord& fluid_;
  Immersion in_;
  Vec3<Velocity> lift_{};  // of a body that displaces its own mass
  TickGain gain_;
};

void leave_out_locked(const BodyRecord& body, TickGain& gain) {
  for (int i = 0; i < 3; ++i) {
    if (body.is_locked(i)) gain.velocity[i] = {};
    if (body.is_turn_locked(i)) gain.spin[i] = {};
  }
}

void push_body(WorldData& world, std::uint32_t body) {
  BodyRecord& record = world.bodies[body];
  const Vec3<Position> position = mid_tick_position(world, record);
  std::optional<BodyRecord> middle;  // once a fluid holds it
  TickGain sum;
  for (std::uint32_t i = 0; i < world.header.fluid_limit; ++i) {
    const FluidRecord& fluid = world.fluids[i];
    const Position reach = Position::from_raw(std::int64_t{1} << (32 + record.scale_exponent));
    if (!fluid.exists() || (fluid.mask & record.category) == 0) continue;
    if (!is_inside(fluid, position, reach)) continue;
    if (!middle) middle = in_mid_tick(world, body, position);
    const TickGain gain = FluidPush(world, body, *middle, fluid).gain();
    for (int axis = 0; axis < 3; ++axis) {
      const auto add = [](Velocity& to, Velocity x) { to += clamp(x, -k_most_gain, k_most_gain); };
      add(sum.velocity[axis], gain.velocity[axis]);
      add(sum.spin[axis], gain.spin[axis]);
    }
  }
  leave_out_locked(record, sum);
  if (sum.velocity == Vec3<Velocity>{} && sum.spin == Vec3<Velocity>{}) return;
  if (!record.is_pushed())
    world.rests.push_back(
        {body, record.rest_ticks, record.union_a, record.union_b, record.union_c});
  add_gain(record, sum);
}

void push_all(WorldData& world) {
  world.rests.clear();
  for (const std::uint32_t body : world.awake.list())
    if (world.bodies[body].is_dynamic()) push_body(world, body);
}

void bring_back_rests(WorldData& world) {
  for (const SavedRest& rest : world.rests) {
    BodyRecord& record = world.bodies[rest.body];
    record.rest_ticks = rest.ticks;
    record.union_a = rest.union_a;
    record.union_b = rest.union_b;
    record.union_c = rest.union_c;
  }
}

}  // namespace

const FluidPhase& fluid_phase() {
  static constexpr FluidPhase k_phase{push_all, bring_back_rests};
  return k_phase;
}

}  // namespace lockstone
