// The rules of a world about pairs of bodies and of tags.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/dynamics/state/rule_records.h"
#include "core/world/state/world_header.h"

namespace lockstone {

/// Canonical state: of each table the first records, as many as the header counts, by key.
struct RuleTables {
  std::array<PairRuleRecord, k_max_pair_rules> pair_rules;
  std::array<SurfaceRuleRecord, k_max_surface_rules> surface_rules;
};

[[nodiscard]] inline std::span<const PairRuleRecord> pair_rules_of(const RuleTables& tables,
                                                                   const WorldHeader& header) {
  return std::span(tables.pair_rules)
      .first(std::min<std::size_t>(header.pair_rule_count, k_max_pair_rules));
}
[[nodiscard]] inline std::span<const SurfaceRuleRecord> surface_rules_of(
    const RuleTables& tables, const WorldHeader& header) {
  return std::span(tables.surface_rules)
      .first(std::min<std::size_t>(header.surface_rule_count, k_max_surface_rules));
}

/// Null where there is none.
[[nodiscard]] const PairRuleRecord* find_rule(std::span<const PairRuleRecord> rules,
                                              const RuleKey& key);
[[nodiscard]] const SurfaceRuleRecord* find_rule(std::span<const SurfaceRuleRecord> rules,
                                                 const RuleKey& key);

/// The surface that the rules give two bodies with the tags of the surfaces in contact.
[[nodiscard]] std::optional<PairSurface> ruled_surface(const RuleTables& tables,
                                                       const WorldHeader& header,
                                                       const RuleKey& bodies, const RuleKey& tags);

}  // namespace lockstone
