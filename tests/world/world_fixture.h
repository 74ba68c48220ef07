// Small worlds for tests.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <lockstone/literals.h>
#include <lockstone/world.h>

namespace lockstone::test {

/// 60 Hz, 4 substeps, room for a few hundred bodies. Capacities of pairs, contacts and joints that
/// are left as they are become small: a world of the usual ones has 50 MB, which sanitizers take
/// long to hand out.
World make_world(WorldDef def = {.body_capacity = 512},
                 std::shared_ptr<const AssetSet> assets = nullptr);

/// A static box, 100 m square, whose top is the plane y = 0.
BodyHandle add_ground(World& world);

BodyHandle add(World& world, const BodyDef& def);

BodyDef dynamic_body(const Shape& shape, Position x, Position y, Position z);

/// Ground and `count` mixed shapes with random poses and velocities above it.
void fill_with_random_bodies(World& world, std::uint64_t seed, int count);

void step(World& world, int ticks);

std::vector<std::byte> save(const World& world, SnapshotKind kind);

/// A clock for profiles: one tick a call.
std::uint64_t counting_clock();
/// How often it was called.
std::uint64_t clock_calls();

/// Metres as a floating-point number, for messages and loose bounds.
double metres(Position x);
double metres_per_second(Velocity v);

}  // namespace lockstone::test
