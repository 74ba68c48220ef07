// A road, and vehicles on it.
#pragma once

#include <cmath>

#include <gtest/gtest.h>

#include <lockstone/vehicle.h>

#include "tests/world/world_fixture.h"

namespace lockstone::test {

inline constexpr double k_earth_gravity = 9.81;
inline constexpr Unit k_full = Unit::from_integer(1);

/// A half-space of friction 1, and room for 16 vehicles.
inline World make_road(std::uint16_t tick_rate = 60) {
  World world = make_world({.body_capacity = 64, .tick_rate = tick_rate, .vehicle_capacity = 16});
  BodyDef ground;
  ground.motion = MotionType::static_body;
  ground.shape = Shape::half_space();
  ground.material.friction = Coefficient::from_integer(1);
  add(world, ground);
  return world;
}

inline void add_step(World& world, const Shape& shape, const Vec3<Position>& position) {
  BodyDef step;
  step.motion = MotionType::static_body;
  step.shape = shape;
  step.position = position;
  add(world, step);
}

inline BodyHandle add_vehicle(World& world, const VehicleDef& vehicle, const BodyDef& def) {
  const BodyHandle body = add(world, def);
  EXPECT_EQ(world.apply(SetVehicle{body, vehicle}), Status::ok);
  return body;
}

inline void drive(World& world, BodyHandle vehicle, const VehicleControls& controls) {
  EXPECT_EQ(world.apply(DriveVehicle{vehicle, controls}), Status::ok);
}

inline double ground_speed(const World& world, BodyHandle body) {
  const Vec3<Velocity> v = world.velocity(body);
  return std::hypot(metres_per_second(v.x), metres_per_second(v.z));
}

}  // namespace lockstone::test
