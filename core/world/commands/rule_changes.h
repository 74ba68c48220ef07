// Checks and changes of the rules about pairs.
#pragma once

#include <cstdint>

#include "core/dynamics/state/rule_records.h"
#include "core/world/data/world_data.h"

namespace lockstone {

/// Whether each table has room for a rule with this key.
[[nodiscard]] bool has_room_for_rule(const WorldData& world, const RuleKey& bodies);
[[nodiscard]] bool has_room_for_surface_rule(const WorldData& world, const RuleKey& tags);

/// Removes the rules that name a body.
void forget_rules_of(WorldData& world, std::uint32_t body);

}  // namespace lockstone
