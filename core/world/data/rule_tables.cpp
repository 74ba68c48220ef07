#include "core/world/data/rule_tables.h"

#include "core/world/data/sorted_table.h"

namespace lockstone {

const PairRuleRecord* find_rule(std::span<const PairRuleRecord> rules, const RuleKey& key) {
  LKS_ASSERT(key.low <= key.high);
  return find_by_key(rules, key);
}

const SurfaceRuleRecord* find_rule(std::span<const SurfaceRuleRecord> rules, const RuleKey& key) {
  LKS_ASSERT(key.low <= key.high);
  return find_by_key(rules, key);
}

std::optional<PairSurface> ruled_surface(const RuleTables& tables, const WorldHeader& header,
                                         const RuleKey& bodies, const RuleKey& tags) {
  const PairRuleRecord* pair = find_rule(pair_rules_of(tables, header), bodies);
  if (pair != nullptr && pair->has_surface()) return pair->surface;
  const SurfaceRuleRecord* surface = find_rule(surface_rules_of(tables, header), tags);
  if (surface != nullptr) return surface->surface;
  return {};
}

}  // namespace lockstone
