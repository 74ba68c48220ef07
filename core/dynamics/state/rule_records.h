// Rules about pairs as they are stored, saved and hashed.
#pragma once

#include <compare>
#include <cstdint>

#include <lockstone/rules.h>

#include "core/dynamics/state/fields.h"

namespace lockstone {

/// Bits of PairRuleRecord::flags.
enum PairRuleFlag : std::uint32_t {
  k_pair_ignored = 1,
  k_pair_has_surface = 2,
  k_all_pair_rule_flags = k_pair_ignored | k_pair_has_surface,
};

/// Two numbers that name a rule, the lower one first.
struct RuleKey {
  std::uint32_t low = 0;
  std::uint32_t high = 0;

  friend constexpr auto operator<=>(const RuleKey&, const RuleKey&) = default;
};
[[nodiscard]] constexpr RuleKey rule_key(std::uint32_t a, std::uint32_t b) {
  return a < b ? RuleKey{a, b} : RuleKey{b, a};
}

/// The rule of two bodies. Records are sorted by key; the surface is zero without its flag.
struct PairRuleRecord {
  std::uint32_t body_a = 0;  // the lower index
  std::uint32_t body_b = 0;
  std::uint32_t flags = 0;  // PairRuleFlag, at least one
  PairSurface surface{};

  friend bool operator==(const PairRuleRecord&, const PairRuleRecord&) = default;

  [[nodiscard]] RuleKey key() const { return {body_a, body_b}; }
  [[nodiscard]] bool is_ignored() const { return (flags & k_pair_ignored) != 0; }
  [[nodiscard]] bool has_surface() const { return (flags & k_pair_has_surface) != 0; }
};

/// The surface of two tags. Records are sorted by key.
struct SurfaceRuleRecord {
  std::uint32_t tag_a = 0;  // not above tag_b
  std::uint32_t tag_b = 0;
  PairSurface surface{};

  friend bool operator==(const SurfaceRuleRecord&, const SurfaceRuleRecord&) = default;

  [[nodiscard]] RuleKey key() const { return {tag_a, tag_b}; }
};

template <class F>
constexpr void visit_surface(PairSurface& surface, F&& f) {
  visit_value("friction", "", surface.friction, f);
  visit_value("restitution", "", surface.restitution, f);
  visit_value("rolling_resistance", "", surface.rolling_resistance, f);
}

template <class F>
constexpr void visit_fields(PairRuleRecord& record, F&& f) {
  visit_value("body_a", "", record.body_a, f);
  visit_value("body_b", "", record.body_b, f);
  visit_value("flags", "", record.flags, f);
  visit_surface(record.surface, f);
}

template <class F>
constexpr void visit_fields(SurfaceRuleRecord& record, F&& f) {
  visit_value("tag_a", "", record.tag_a, f);
  visit_value("tag_b", "", record.tag_b, f);
  visit_surface(record.surface, f);
}

static_assert(visited_bytes<PairRuleRecord>() == sizeof(PairRuleRecord), "a field is missing");
static_assert(visited_bytes<SurfaceRuleRecord>() == sizeof(SurfaceRuleRecord),
              "a field is missing");

}  // namespace lockstone
