#include "core/world/data/rule_tables.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone {
namespace {

template <class Record>
const Record* find_by_key(std::span<const Record> rules, const RuleKey& key) {
  LKS_ASSERT(key.low <= key.high);
  const auto at = std::ranges::lower_bound(rules, key, {}, &Record::key);
  return at != rules.end() && at->key() == key ? &*at : nullptr;
}

}  // namespace

const PairRuleRecord* find_rule(std::span<const PairRuleRecord> rules, const RuleKey& key) {
  return find_by_key(rules, key);
}

const SurfaceRuleRecord* find_rule(std::span<const SurfaceRuleRecord> rules, const RuleKey& key) {
  return find_by_key(rules, key);
}

std::optional<PairSurface> ruled_surface(const RuleTables& tables, const WorldHeader& header,
                                         const RuleKey& bodies, const RuleKey& tags) {
  const PairRuleRecord* pair = find_rule(pair_rules_of(tables, header), bodies);
  if (pair != nullptr && pair->has_surface()) return pair->surface();
  const SurfaceRuleRecord* surface = find_rule(surface_rules_of(tables, header), tags);
  if (surface != nullptr) return surface->surface();
  return {};
}

}  // namespace lockstone
