// Commands on bodies and on the world: a function each.
#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

// A command that names a body and has one more vector: Command{body, vector, rest…}.
template <class Command, class T, class Raw, class... Rest>
lks_status push(lks_world* world, lks_body body, const Raw* vector, const char* name,
                Rest... rest) {
  return call([&] {
    order(world, Command{handle_of<BodyHandle>(body), vec<T>(required(vector, name)), rest()...});
  });
}

template <class Command>
lks_status move(lks_world* world, lks_body body, const lks_pose* pose) {
  return call([&] {
    const lks_pose& target = required(pose, "pose");
    order(world, Command{handle_of<BodyHandle>(body), vec<Position>(target.position),
                         quat_of(target.orientation)});
  });
}

template <class Command>
lks_status tell(lks_world* world, lks_body body) {
  return call([&] { order(world, Command{handle_of<BodyHandle>(body)}); });
}

}  // namespace

lks_status lks_destroy_body(lks_world* world, lks_body body) {
  return tell<DestroyBody>(world, body);
}

lks_status lks_teleport(lks_world* world, lks_body body, const lks_pose* pose) {
  return move<Teleport>(world, body, pose);
}

lks_status lks_set_velocity(lks_world* world, lks_body body, const lks_velocity3* velocity) {
  return push<SetVelocity, Velocity>(world, body, velocity, "velocity");
}

lks_status lks_set_angular_velocity(lks_world* world, lks_body body,
                                    const lks_angular_velocity3* velocity) {
  return push<SetAngularVelocity, AngularVelocity>(world, body, velocity, "velocity");
}

lks_status lks_apply_impulse(lks_world* world, lks_body body, const lks_impulse3* impulse,
                             uint32_t frame) {
  return push<ApplyImpulse, Impulse>(world, body, impulse, "impulse",
                                     [&] { return frame_of(frame); });
}

lks_status lks_apply_impulse_at(lks_world* world, lks_body body, const lks_impulse3* impulse,
                                const lks_length3* point, uint32_t frame) {
  return push<ApplyImpulseAt, Impulse>(
      world, body, impulse, "impulse", [&] { return vec<Length>(required(point, "point")); },
      [&] { return frame_of(frame); });
}

lks_status lks_apply_angular_impulse(lks_world* world, lks_body body, const lks_impulse3* impulse,
                                     uint32_t frame) {
  return push<ApplyAngularImpulse, AngularImpulse>(world, body, impulse, "impulse",
                                                   [&] { return frame_of(frame); });
}

lks_status lks_apply_force(lks_world* world, lks_body body, const lks_force3* force,
                           uint32_t frame) {
  return push<ApplyForce, Force>(world, body, force, "force", [&] { return frame_of(frame); });
}

lks_status lks_apply_force_at(lks_world* world, lks_body body, const lks_force3* force,
                              const lks_length3* point, uint32_t frame) {
  return push<ApplyForceAt, Force>(
      world, body, force, "force", [&] { return vec<Length>(required(point, "point")); },
      [&] { return frame_of(frame); });
}

lks_status lks_apply_torque(lks_world* world, lks_body body, const lks_force3* torque,
                            uint32_t frame) {
  return push<ApplyTorque, Torque>(world, body, torque, "torque", [&] { return frame_of(frame); });
}

lks_status lks_move_kinematic(lks_world* world, lks_body body, const lks_pose* pose) {
  return move<MoveKinematic>(world, body, pose);
}

lks_status lks_set_material(lks_world* world, lks_body body, const lks_surface* surface) {
  return call([&] {
    order(world, SetMaterial{handle_of<BodyHandle>(body),
                             surface_of(required(surface, "surface"), "surface")});
  });
}

lks_status lks_set_surface_motion(lks_world* world, lks_body body,
                                  const lks_surface_motion* motion) {
  return call([&] {
    order(world, SetSurfaceMotion{handle_of<BodyHandle>(body),
                                  surface_motion_of(required(motion, "motion"))});
  });
}

lks_status lks_set_gravity_scale(lks_world* world, lks_body body, lks_number scale) {
  return call([&] {
    order(world, SetGravityScale{handle_of<BodyHandle>(body), Number::from_raw(scale)});
  });
}

lks_status lks_set_damping(lks_world* world, lks_body body, lks_rate linear, lks_rate angular) {
  return call([&] {
    order(world,
          SetDamping{handle_of<BodyHandle>(body), Rate::from_raw(linear), Rate::from_raw(angular)});
  });
}

lks_status lks_set_axis_locks(lks_world* world, lks_body body, uint32_t locks) {
  return call([&] {
    order(world, SetAxisLocks{handle_of<BodyHandle>(body), locks_of(locks, "locks")});
  });
}

lks_status lks_set_speed_limit(lks_world* world, lks_body body, lks_velocity linear,
                               lks_angular_velocity angular) {
  return call([&] {
    const SpeedLimit limit{Velocity::from_raw(linear), AngularVelocity::from_raw(angular)};
    order(world, SetSpeedLimit{handle_of<BodyHandle>(body), limit});
  });
}

lks_status lks_set_filter(lks_world* world, lks_body body, const lks_filter* filter) {
  return call([&] {
    order(world, SetFilter{handle_of<BodyHandle>(body), filter_of(required(filter, "filter"))});
  });
}

lks_status lks_set_events(lks_world* world, lks_body body, uint32_t events, lks_speed hit_speed) {
  return call([&] {
    order(world, SetEvents{handle_of<BodyHandle>(body), events_of(events, hit_speed, "events")});
  });
}

lks_status lks_set_user_data(lks_world* world, lks_body body, uint64_t user_data) {
  return call([&] { order(world, SetUserData{handle_of<BodyHandle>(body), user_data}); });
}

lks_status lks_set_motion_type(lks_world* world, lks_body body, uint32_t motion, lks_mass mass) {
  return call([&] {
    const MotionType type =
        enumerator(motion, MotionType::static_body, MotionType::dynamic, "motion");
    order(world, SetMotionType{handle_of<BodyHandle>(body), type, Mass::from_raw(mass)});
  });
}

lks_status lks_set_shape(lks_world* world, lks_body body, const lks_shape* shape, lks_mass mass) {
  return call([&] {
    order(world, SetShape{handle_of<BodyHandle>(body),
                          shape_of(required(shape, "shape"), "shape.kind"), Mass::from_raw(mass)});
  });
}

lks_status lks_set_mass_data(lks_world* world, lks_body body, lks_mass mass,
                             const lks_inertia3* inertia) {
  return call([&] {
    MassData data{Mass::from_raw(mass), {}};
    if (inertia != nullptr) data.inertia = vec<MomentOfInertia>(*inertia);
    order(world, SetMassData{handle_of<BodyHandle>(body), data});
  });
}

lks_status lks_set_enabled(lks_world* world, lks_body body, uint32_t enabled) {
  return call([&] {
    order(world, SetEnabled{handle_of<BodyHandle>(body), flag(enabled, "enabled")});
  });
}

lks_status lks_wake_body(lks_world* world, lks_body body) {
  return tell<WakeBody>(world, body);
}

lks_status lks_sleep_body(lks_world* world, lks_body body) {
  return tell<SleepBody>(world, body);
}

lks_status lks_set_allow_sleep(lks_world* world, lks_body body, uint32_t allow) {
  return call([&] {
    order(world, SetAllowSleep{handle_of<BodyHandle>(body), flag(allow, "allow")});
  });
}

lks_status lks_set_gravity(lks_world* world, const lks_acceleration3* gravity) {
  return call([&] { order(world, SetGravity{vec<Acceleration>(required(gravity, "gravity"))}); });
}
