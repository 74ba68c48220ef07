// The part of a world's state that stands before its stores.
#pragma once

#include <cstddef>
#include <cstdint>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/dynamics/state/fields.h"

namespace lockstone {

/// The part of the state that belongs to no object.
struct WorldHeader {
  std::uint64_t tick = 0;
  Vec3<Acceleration> gravity{};
  std::uint32_t body_limit = 0;  // slots ever used
  std::uint32_t contact_count = 0;
  std::uint32_t joint_limit = 0;  // slots ever used
  // Bytes of one word, so that a world without rules and vehicles is as it was before.
  std::uint8_t fluid_limit = 0;  // fluids of higher numbers do not exist
  std::uint8_t surface_rule_count = 0;
  std::uint8_t pair_rule_count = 0;
  std::uint8_t vehicle_count = 0;
  // Hashed only where it is not zero (k_hashed_header_bytes).
  std::uint32_t terrain_tile_count = 0;
  std::uint32_t reserved = 0;

  friend bool operator==(const WorldHeader&, const WorldHeader&) = default;
};

template <class F>
constexpr void visit_fields(WorldHeader& header, F&& f) {
  visit_value("tick", "", header.tick, f);
  visit_value("gravity", "", header.gravity, f);
  visit_value("body_limit", "", header.body_limit, f);
  visit_value("contact_count", "", header.contact_count, f);
  visit_value("joint_limit", "", header.joint_limit, f);
  visit_value("fluid_limit", "", header.fluid_limit, f);
  visit_value("surface_rule_count", "", header.surface_rule_count, f);
  visit_value("pair_rule_count", "", header.pair_rule_count, f);
  visit_value("vehicle_count", "", header.vehicle_count, f);
  visit_value("terrain_tile_count", "", header.terrain_tile_count, f);
  visit_value("reserved", "", header.reserved, f);
}

static_assert(visited_bytes<WorldHeader>() == sizeof(WorldHeader), "a field is missing");

/// A world without tiles is hashed as before there were any.
inline constexpr std::size_t k_hashed_header_bytes = offsetof(WorldHeader, terrain_tile_count);

}  // namespace lockstone
