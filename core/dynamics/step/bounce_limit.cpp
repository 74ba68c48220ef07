// Restitution says how fast points part, whatever friction and turning make of the way there, and
// so may give bodies more than they had (T. R. Kane, "A dynamics puzzle", 1984). Here bounces of an
// island are scaled down until its energy at the tick's end is no more than gravity and forces
// account for.

#include "core/dynamics/body/energy.h"
#include "core/dynamics/body/motion.h"
#include "core/dynamics/step/contact_solver.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

// Twice the kinetic energy for each mass.
std::int64_t twice_energy(const BodyRecord& body, const InverseInertia& inertia) {
  return energy_product(body.velocity, body.velocity, body.spin,
                        surface_velocity(inertia, body.spin));
}

InverseInertia inertia_now(const BodyRecord& body) {
  return inverse_inertia(body, to_matrix(body.orientation));
}

}  // namespace

// Marks islands that restitution, and those that moving surfaces and drives, may give energy.
void ContactSolver::find_fed_islands(const ContactScene& scene) {
  const auto moves = [&](std::uint32_t index) {
    const BodyRecord& body = scene.bodies[index];
    return !body.is_dynamic() &&
           (body.velocity != Vec3<Velocity>{} || body.spin != Vec3<Velocity>{});
  };
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const ContactRecord& record = scene.records[entries_[i].record];
    const ContactSurface& surface = scene.surfaces[entries_[i].slot];
    if (surface.restitution != Coefficient{}) island_of(i).may_bounce = true;
    if (moves(record.body_a) || moves(record.body_b) || surface.twist_drive != Rate{} ||
        surface.drive != Vec3<SolverVelocity>{})
      island_of(i).is_fed = true;
  }
  for (const JointLink& link : scene.joint_links) {
    const auto& axes = scene.joints[link.joint].axes;
    const bool is_fed = std::ranges::any_of(axes, &JointAxisRecord::is_driven) ||
                        moves(link.body_a) || moves(link.body_b);
    for (const std::uint32_t body : {link.body_a, link.body_b}) {
      if (!scene.bodies[body].is_dynamic()) continue;
      IslandLoad& load = islands_.load(islands_.of(solver_index_[body]));
      load.has_joints = true;
      load.is_fed = load.is_fed || is_fed;
    }
  }
}

void ContactSolver::keep_speeds(std::size_t first, std::size_t end) {
  for (std::size_t i = first; i < end; ++i) {
    before_[i] = rows_[i];
    gained_[i] = 0;
  }
}

// Once a body has moved: its gain of energy, less the work of gravity and forces on its way.
void ContactSolver::note_gain(std::size_t index, const BodyRecord& body, const BodyRecord& start) {
  ProductSum work;  // twice of each mass, by half a substep's rate
  for (int i = 0; i < 3; ++i)
    work.add(bodies_[index].gain[static_cast<std::size_t>(i)],
             (body.position[i].raw - start.position[i].raw) * step_.substep_rate());
  gained_[index] = twice_energy(body, inertia_now(body)) -
                   twice_energy(start, bodies_[index].inverse_inertia) - work.rounded(31);
}

// Velocity and spin before the bounces, and the gains that bounces gave.
ContactSolver::Bounce ContactSolver::bounce_of(std::size_t index, const BodyRecord& body) const {
  const auto read = [](const auto& v) {
    const auto part = [](std::int64_t x) {
      return Velocity::from_raw(x >> (lanes::k_velocity_bits - lanes::k_grid_bits));
    };
    return Vec3<Velocity>{part(v[0]), part(v[1]), part(v[2])};
  };
  const Vec3<Velocity> velocity = read(before_[index].velocity), spin = read(before_[index].spin);
  return {velocity, spin, body.velocity - velocity, body.spin - spin};
}

// The greatest share s of its bounces with which an island gains nothing; their own gain of energy
// is s²·square + s·linear.
std::int32_t ContactSolver::share_of_bounces(const IslandGain& gain) {
  const std::int64_t allowed =
      raw::saturating_add(raw::saturating_add(gain.square, gain.linear), -gain.gained);
  return greatest_share(gain.square, gain.linear, allowed);
}

template <class Visit>
void ContactSolver::for_gaining(const Visit& visit) {
  for (std::uint32_t i = 1; i < members_.size(); ++i) {
    IslandGain& gain = gains_[islands_.of(i)];
    if (islands_.of(i) != 0 && gain.gained > 0) visit(i, gain);
  }
}

// Masses count as parts of that of the island's first body.
void ContactSolver::limit_bounces(std::span<BodyRecord> bodies, Velocity speed_limit) {
  if (!bounces_) return;
  gains_.assign(islands_.count(), {});
  const auto add = [this](std::uint32_t i, const IslandGain& gain, std::int64_t& sum,
                          std::int64_t each) {
    const BlockFloat mass = quotient(gain.unit, bodies_[i].inverse_mass);
    sum = raw::saturating_add(sum, scale_saturating(each, mass, 0));
  };
  for (std::uint32_t i = 1; i < members_.size(); ++i) {
    IslandGain& gain = gains_[islands_.of(i)];
    const IslandLoad& load = islands_.load(islands_.of(i));
    if (!load.may_bounce || load.is_fed || !bodies_[i].is_pushed()) continue;
    if (gain.unit == BlockFloat{}) gain.unit = bodies_[i].inverse_mass;
    add(i, gain, gain.gained, gained_[i]);
  }
  for_gaining([&](std::uint32_t i, IslandGain& gain) {
    const BodyRecord& body = bodies[members_[i]];
    const Bounce bounce = bounce_of(i, body);
    const Vec3<Velocity> gained = surface_velocity(inertia_now(body), bounce.spin_gain);
    add(i, gain, gain.square,
        energy_product(bounce.velocity_gain, bounce.velocity_gain, bounce.spin_gain, gained));
    add(i, gain, gain.linear,
        2 * energy_product(bounce.velocity, bounce.velocity_gain, bounce.spin, gained));
  });
  for (IslandGain& gain : gains_)
    if (gain.gained > 0) gain.share = share_of_bounces(gain);
  for_gaining([&](std::uint32_t i, const IslandGain& gain) {
    BodyRecord& body = bodies[members_[i]];
    const Bounce bounce = bounce_of(i, body);
    for (int axis = 0; axis < 3; ++axis) {
      const auto part = [&](Velocity v) { return times(v, Unit::from_raw(gain.share)); };
      body.velocity[axis] = bounce.velocity[axis] + part(bounce.velocity_gain[axis]);
      body.spin[axis] = bounce.spin[axis] + part(bounce.spin_gain[axis]);
    }
    hold_axes(body);
    (void)limit_speed(body, inertia_now(body), speed_limit);
  });
}

}  // namespace lockstone
